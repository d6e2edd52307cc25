// Elements, created from names and texts. Values of results are inserted as text, never as markup.

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") node.addEventListener(name, value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

function byId(id) {
  return document.getElementById(id);
}

function button(text, action, attributes = {}) {
  return element("button", { type: "button", click: action, ...attributes }, text);
}

// A labelled select element; `change` gets the index of the selected text.
function choice(label, texts, chosen, change) {
  const select = element("select", { change: () => change(select.selectedIndex) });
  texts.forEach((text, i) => select.append(element("option", { selected: i === chosen }, text)));
  return element("label", { class: "choice" }, element("span", {}, label), select);
}

function announce(text) {
  byId("announcer").textContent = text;
}

// Status marks: shapes that do not rely on colour.
const kStatusMarks = { ok: "✓", mismatch: "≠", timeout: "◔", unsupported: "∅", error: "!" };

// Names from results may equal names of inherited properties.
const ownProperty = (object, name) => (Object.prototype.hasOwnProperty.call(object, name) ? object[name] : undefined);

function statusMark(status) {
  const [word] = status.split(",");  // "ok, 1 of 3 repetitions"
  const mark = ownProperty(kStatusMarks, word);
  return element("span", { class: `status ${mark ? word : "error"}` },
                 element("span", { "aria-hidden": "true" }, mark || "!"), ` ${status}`);
}

// Elements are drawn when they come near the viewport; `drawAll` draws all pending elements.
const pendingDraws = new Map();
const viewportObserver = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) drawNow(entry.target);
}, { rootMargin: "300px" });

function drawWhenVisible(node, draw) {
  pendingDraws.set(node, draw);
  viewportObserver.unobserve(node);
  viewportObserver.observe(node);
}

function drawNow(node) {
  const draw = pendingDraws.get(node);
  pendingDraws.delete(node);
  viewportObserver.unobserve(node);
  if (draw && node.isConnected) draw();
}

function drawAll() {
  while (pendingDraws.size) for (const node of [...pendingDraws.keys()]) drawNow(node);
}

// A container that scrolls sideways, and shows while there is more to the right.
function scrollable(node, attributes = {}) {
  const scroll = element("div", { class: "scroll", ...attributes }, node);
  const frame = element("div", { class: "scroll-frame" },
    element("p", { class: "muted note on-screen scroll-hint", "aria-hidden": "true" }, "scroll sideways for more →"), scroll);
  const update = () => frame.classList.toggle("more", scroll.scrollLeft + scroll.clientWidth < scroll.scrollWidth - 1);
  scroll.addEventListener("scroll", update, { passive: true });
  const sizes = new ResizeObserver(update);
  sizes.observe(scroll);
  sizes.observe(node);
  return frame;
}
