// The figures of the lesson: boxes that move and can be dragged, and what an algorithm makes of them.
"use strict";

const kWorld = { width: 16, height: 10 };
const kRoles = ["cell", "cell_part", "split", "best_split", "moving_node", "resting_node"];
const kSeconds = 1 / 60;  // of motion per picture
const kFloats = 8;        // of a box: the lower corner, the upper one, four each

// The same boxes for everybody.
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

const number = (value) => value.toLocaleString("en");
const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);

class Figure {
  constructor(module, index, node) {
    Object.assign(this, { module, index, node, held: null, isVisible: false });
    this.algorithm = node.dataset.algorithm;
    this.canvas = element("canvas", { tabIndex: -1 });
    this.canvas.setAttribute("aria-label", `Boxes, and the structure of the algorithm ${this.algorithm}`);
    this.caption = element("figcaption");
    const slider = (name, max, step, value, change) => {
      const input = element("input", { type: "range", min: 0, max, step, value, name });
      input.addEventListener("input", () => change(Number(input.value)));
      return element("label", {}, name, input);
    };
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.speed = still ? 0 : Number(node.dataset.speed || 1);
    const count = Number(node.dataset.bodies);
    const sliders = [
      slider("boxes", Math.max(400, 2 * count), 10, count, (value) => this.place(Math.max(2, value))),
      slider("speed", 3, 0.05, this.speed, (value) => { this.speed = value; })];
    this.parameters = node.dataset.parameters || "";
    if (node.dataset.slider) {  // "TITLE;PARAMETER;GREATEST;VALUE"
      const [title, key, max, value] = node.dataset.slider.split(";");
      const set = (chosen) => {
        this.parameters = [node.dataset.parameters, `${key}=${Math.max(1, chosen)}`].filter(Boolean).join(",");
      };
      set(Number(value));
      sliders.push(slider(title, max, 1, value, (chosen) => { set(chosen); this.start(); }));
    }
    node.append(this.canvas, element("div", { className: "controls" }, ...sliders), this.caption);
    this.listen();
    this.place(count);
  }

  // Places this many boxes.
  place(count) {
    const random = randomNumbers(7);
    const size = 0.5 * Math.sqrt((kWorld.width * kWorld.height) / count);
    this.bodies = Array.from({ length: count }, () => {
      const angle = 2 * Math.PI * random();
      return { x: kWorld.width * random(), y: kWorld.height * random(),
               width: size * (0.3 + 0.5 * random()), height: size * (0.3 + 0.5 * random()),
               vx: Math.cos(angle), vy: Math.sin(angle) };
    });
    this.held = null;
    this.start();
  }

  // Starts the algorithm on the boxes.
  start() {
    this.boxes = this.module.ccall("lessonStart", "number", ["number", "string", "string", "number"],
                                   [this.index, this.algorithm, this.parameters, this.bodies.length]);
    this.run();
  }

  move() {
    for (const body of this.bodies) {
      if (body === this.held?.body) continue;
      body.x += body.vx * this.speed * kSeconds;
      body.y += body.vy * this.speed * kSeconds;
    }
    for (const body of this.bodies) {
      if (body.x < body.width / 2) body.vx = Math.abs(body.vx);
      if (body.x > kWorld.width - body.width / 2) body.vx = -Math.abs(body.vx);
      if (body.y < body.height / 2) body.vy = Math.abs(body.vy);
      if (body.y > kWorld.height - body.height / 2) body.vy = -Math.abs(body.vy);
    }
  }

  // Runs the algorithm on the boxes, and shows its answer.
  run() {
    const floats = this.module.HEAPF32.subarray(this.boxes / 4);
    this.bodies.forEach((body, i) => {
      floats.set([body.x - body.width / 2, body.y - body.height / 2, 0.25, 0,
                  body.x + body.width / 2, body.y + body.height / 2, 0.75, 0], kFloats * i);
    });
    this.answer = JSON.parse(this.module.ccall("lessonFrame", "string", ["number"], [this.index]));
    // A tree with margins reports some more.
    const corner = (body, k) => floats[kFloats * body + k];
    const overlap = ([a, b]) => [0, 1].every((axis) => (
      corner(a, axis) <= corner(b, axis + 4) && corner(b, axis) <= corner(a, axis + 4)));
    this.answer.overlapping = this.answer.pairs.filter(overlap);
    this.draw();
    this.describe();
  }

  describe() {
    const { pairs, overlapping, tests, cells, counters } = this.answer;
    const count = this.bodies.length;
    const all = count * (count - 1) / 2;
    const extra = pairs.length - overlapping.length;
    const tested = tests.reduce((sum, some) => sum + some, 0) / 2;
    const parts = [
      `${number(count)} boxes, ${number(all)} pairs: ${number(overlapping.length)} overlap`
        + (extra ? `, and ${number(extra)} more in their margin` : ""),
      tests.length ? `tests: ${number(tested)} (${(100 * tested / all).toFixed(tested < all / 10 ? 1 : 0)} %)` : "",
      cells.length ? `${this.algorithm === "dbvt-f" ? "nodes" : "cells"}: ${number(cells.length)}` : "",
      this.algorithm === "axis-sweep" || this.algorithm === "dbvt-f"
        ? Object.entries(counters).map(([name, some]) => `${name}: ${number(some)}`).join(", ") : "",
    ];
    this.caption.textContent = `${parts.filter(Boolean).join("; ")}.`;
  }

  draw() {
    const { canvas, answer } = this;
    const wide = canvas.clientWidth * devicePixelRatio;
    if (!wide) return;
    const scale = wide / kWorld.width;
    const intervals = this.node.dataset.intervals ? 0.9 : 0;  // room for them, in units of the world
    const high = Math.round((kWorld.height + intervals) * scale);
    if (canvas.width !== Math.round(wide) || canvas.height !== high) {
      [canvas.width, canvas.height] = [Math.round(wide), high];
    }
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = colourOf("background");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.setTransform(scale, 0, 0, scale, 0, intervals * scale / 2);
    const pixel = devicePixelRatio / scale;

    const paired = new Set(answer.overlapping.flat());
    const near = new Set(answer.pairs.flat());
    const colours = ["free", "allowed_extra", "overlapping"].map(colourOf);
    this.bodies.forEach((body, i) => {
      context.fillStyle = colours[paired.has(i) ? 2 : near.has(i) ? 1 : 0];
      context.fillRect(body.x - body.width / 2, body.y - body.height / 2, body.width, body.height);
    });
    if (this.held) {
      const { body } = this.held;
      context.strokeStyle = colourOf("selected");
      context.lineWidth = 3 * pixel;
      context.strokeRect(body.x - body.width / 2, body.y - body.height / 2, body.width, body.height);
    }

    const roles = kRoles.map(colourOf);
    context.lineWidth = pixel;
    for (const [left, top, right, bottom, role, level] of answer.cells) {
      context.strokeStyle = roles[role];
      context.globalAlpha = level === 0 ? 1 : 0.7;
      context.strokeRect(left, top, right - left, bottom - top);
    }
    context.globalAlpha = 1;
    if (intervals) this.drawIntervals(context, pixel, paired, roles);
  }

  // The boxes' intervals on the sort axes.
  drawIntervals(context, pixel, paired, roles) {
    const [free, overlapping] = ["axis-0", "overlapping"].map(colourOf);
    for (const [left, top, right, bottom, role] of this.answer.lines) {
      const along = right - left > bottom - top ? "x" : "y";
      const length = along === "x" ? right - left : bottom - top;
      if (length < kWorld.height / 2) continue;  // the axis that points at the reader
      context.fillStyle = roles[role];
      const extent = along === "x" ? "width" : "height";
      if (along === "x") context.fillRect(0, kWorld.height, kWorld.width, 2 * pixel);
      else context.fillRect(0, 0, 2 * pixel, kWorld.height);
      context.globalAlpha = 0.45;
      this.bodies.forEach((body, i) => {
        context.fillStyle = paired.has(i) ? overlapping : free;
        const rows = 6;
        const row = (i % rows) * 0.065 + 0.05;
        const begin = body[along] - body[extent] / 2;
        if (along === "x") context.fillRect(begin, kWorld.height + row, body[extent], 0.05);
        else context.fillRect(row, begin, 0.05, body[extent]);
      });
      context.globalAlpha = 1;
    }
  }

  // Pointers: a mouse or fingers drag a box; elsewhere fingers scroll the page.
  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    const scale = kWorld.width / box.width;
    const margin = this.node.dataset.intervals ? 0.45 : 0;
    return { x: (event.clientX - box.left) * scale, y: (event.clientY - box.top) * scale - margin };
  }

  bodyAt({ x, y }) {
    const slop = 0.15;
    return this.bodies.findLast((body) => (
      Math.abs(x - body.x) <= body.width / 2 + slop && Math.abs(y - body.y) <= body.height / 2 + slop));
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("touchstart", (event) => {
      if (this.bodyAt(this.placeOf(event.touches[0]))) event.preventDefault();
    }, { passive: false });
    canvas.addEventListener("pointerdown", (event) => {
      const place = this.placeOf(event);
      const body = this.bodyAt(place);
      if (!body) return;
      this.held = { body, dx: body.x - place.x, dy: body.y - place.y };
      canvas.setPointerCapture(event.pointerId);
      canvas.classList.add("held");
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.held) return;
      const place = this.placeOf(event);
      const { body, dx, dy } = this.held;
      body.x = Math.min(Math.max(place.x + dx, 0), kWorld.width);
      body.y = Math.min(Math.max(place.y + dy, 0), kWorld.height);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, () => {
        this.held = null;
        canvas.classList.remove("held");
      });
    }
  }
}

async function start() {
  const nodes = [...document.querySelectorAll("figure[data-algorithm]")];
  let module = null;
  try {
    module = await loadLesson();
  } catch (error) {
    for (const node of nodes) node.textContent = `The figure needs WebAssembly with vectors: ${error.message}`;
    return;
  }
  const figures = nodes.map((node, i) => new Figure(module, i, node));
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) figures[nodes.indexOf(entry.target)].isVisible = entry.isIntersecting;
  });
  nodes.forEach((node) => observer.observe(node));
  const picture = () => {
    for (const figure of figures.filter((each) => each.isVisible)) {
      figure.move();
      figure.run();
    }
    requestAnimationFrame(picture);
  };
  requestAnimationFrame(picture);
  window.figures = figures;  // for tests
}

start();
