// Elements, made from names and texts. What comes from results becomes text, never markup.

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") made.addEventListener(name, value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return made;
}

function byId(id) {
  return document.getElementById(id);
}

function button(text, action, attributes = {}) {
  return element("button", { type: "button", click: action, ...attributes }, text);
}

// A choice of texts; `change` gets the index of the chosen one.
function choice(label, texts, chosen, change) {
  const select = element("select", { change: () => change(select.selectedIndex) });
  texts.forEach((text, i) => select.append(element("option", { selected: i === chosen }, text)));
  return element("label", { class: "choice" }, element("span", {}, label), select);
}

function speak(text) {
  byId("spoken").textContent = text;
}

// A status as a word in its colour; its shape says the same to who sees no colours.
const kStatusMarks = { ok: "✓", mismatch: "≠", timeout: "◔", unsupported: "∅", error: "!" };

// What results name may be called like something that every object has.
const ownOf = (object, name) => (Object.prototype.hasOwnProperty.call(object, name) ? object[name] : undefined);

function statusMark(status) {
  const [word] = status.split(",");  // "ok, 1 of 3 repetitions"
  const mark = ownOf(kStatusMarks, word);
  return element("span", { class: `status ${mark ? word : "error"}` },
                 element("span", { "aria-hidden": "true" }, mark || "!"), ` ${status}`);
}

// Draws when the element comes near the screen; `drawAll` draws what is still waiting.
const waiting = new Map();
const nearScreen = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) drawNow(entry.target);
}, { rootMargin: "300px" });

function drawWhenSeen(node, draw) {
  waiting.set(node, draw);
  nearScreen.unobserve(node);
  nearScreen.observe(node);
}

function drawNow(node) {
  const draw = waiting.get(node);
  waiting.delete(node);
  nearScreen.unobserve(node);
  if (draw && node.isConnected) draw();
}

function drawAll() {
  while (waiting.size) for (const node of [...waiting.keys()]) drawNow(node);
}
