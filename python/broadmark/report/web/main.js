// Starts the page. Sections are drawn when they come near the viewport, or for printing.

const kSections = { compared: drawCompared, ratios: drawRatios, scaling: drawScaling, memory: drawMemory, frames: drawFrames, worst: drawWorst,
                    failures: drawFailures, cases: drawCases };

// Redraws the sections, those outside the viewport when they come near it.
function refresh() {
  hideTooltip();
  for (const [name, draw] of Object.entries(kSections)) {
    const body = byId(name).querySelector(".body");
    body.setAttribute("aria-busy", "true");
    drawWhenVisible(body, () => {
      draw(body);
      highlight(pinned);
      body.removeAttribute("aria-busy");
    });
  }
}

const systemDark = matchMedia("(prefers-color-scheme: dark)");
let theme = null;  // "dark" or "light"; null: the system's theme

function setTheme(selected) {
  theme = selected;
  const dark = theme ? theme === "dark" : systemDark.matches;
  byId("dark").media = { dark: "screen", light: "not all" }[theme] || "screen and (prefers-color-scheme: dark)";
  byId("theme").textContent = dark ? "Light" : "Dark";
  byId("theme").setAttribute("aria-label", dark ? "Light colours" : "Dark colours");
  byId("theme").onclick = () => setTheme(dark ? "light" : "dark");
}

function setPrinting(printing) {
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
setTheme(null);
refresh();

systemDark.addEventListener("change", () => setTheme(theme));
byId("print").addEventListener("click", () => print());
addEventListener("beforeprint", () => setPrinting(true));
addEventListener("afterprint", () => setPrinting(false));
byId("details").addEventListener("click", (event) => {  // a click on the backdrop
  if (event.target === byId("details")) byId("details").close();
});
let width = innerWidth;
addEventListener("resize", () => {
  if (innerWidth === width || view.printing) return;  // the bars of mobile browsers change only the height
  width = innerWidth;
  refresh();
});
document.documentElement.dataset.ready = Math.round(performance.now());
