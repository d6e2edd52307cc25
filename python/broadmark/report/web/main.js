// Puts the page together: sections are drawn when they come near the screen, or to be printed.

const kSections = { ratios: drawRatios, scaling: drawScaling, memory: drawMemory, frames: drawFrames,
                    failures: drawFailures, cases: drawCases };

// Draws everything anew, what is not on the screen when it comes there.
function refresh() {
  hideTooltip();
  for (const [name, draw] of Object.entries(kSections)) {
    const body = byId(name).querySelector(".body");
    body.setAttribute("aria-busy", "true");
    drawWhenSeen(body, () => {
      draw(body);
      highlight(pinned);
      body.removeAttribute("aria-busy");
    });
  }
}

const systemDark = matchMedia("(prefers-color-scheme: dark)");
let theme = null;  // the reader's choice, or the system's

function useTheme(chosen) {
  theme = chosen;
  const dark = theme ? theme === "dark" : systemDark.matches;
  byId("dark").media = { dark: "screen", light: "not all" }[theme] || "screen and (prefers-color-scheme: dark)";
  byId("theme").textContent = dark ? "Light" : "Dark";
  byId("theme").setAttribute("aria-label", dark ? "Light colours" : "Dark colours");
  byId("theme").onclick = () => useTheme(dark ? "light" : "dark");
}

function usePrinting(printing) {
  view.printing = printing;
  for (const closed of document.querySelectorAll(printing ? "details.more:not([open])" : "[data-opened]")) {
    closed.open = printing;
    closed.toggleAttribute("data-opened", printing);
  }
  refresh();
  if (printing) drawAll();
}

drawSummary();
makeFilters();
showFilters();
useTheme(null);
refresh();

systemDark.addEventListener("change", () => useTheme(theme));
byId("print").addEventListener("click", () => print());
addEventListener("beforeprint", () => usePrinting(true));
addEventListener("afterprint", () => usePrinting(false));
byId("details").addEventListener("click", (event) => {  // outside the panel
  if (event.target === byId("details")) byId("details").close();
});
let width = innerWidth;
addEventListener("resize", () => {
  if (innerWidth === width || view.printing) return;  // a phone's bars only change the height
  width = innerWidth;
  refresh();
});
document.documentElement.dataset.ready = Math.round(performance.now());
