// Scatter charts with logarithmic axes, lines, intervals, and gaps below the plot. A chart is a single
// tab stop; arrow keys move between its points.

// By the index of a symbol (palette.py).
const kSymbols = [d3.symbolCircle, d3.symbolSquare, d3.symbolTriangle, d3.symbolDiamond, d3.symbolStar,
                  d3.symbolCross];
const kDashes = ["", "6 3", "2 3", "9 3 2 3"];
let pinned = null;  // the variant selected in a legend

const kHitRadius = 26;  // in pixels

// Colour and symbol: algorithm; filled: several threads; dashes: other variants.
const styles = new Map();
{
  const styleCounts = new Map();
  for (const testCase of cases) {
    if (styles.has(testCase.variant)) continue;
    const [curve, symbol] = data.looks[testCase.algorithm];
    const key = `${curve} ${symbol} ${testCase.threads > 1}`;
    styleCounts.set(key, (styleCounts.get(key) ?? -1) + 1);
    styles.set(testCase.variant, {
      colour: `var(--curve-${curve})`,
      symbol: kSymbols[symbol],
      filled: testCase.threads > 1,
      dash: kDashes[styleCounts.get(key) % kDashes.length],
    });
  }
}

function drawSymbol(node, style) {
  return node.append("path").attr("class", "symbol")
    .attr("d", d3.symbol().type(style.symbol).size(46)())
    .style("stroke", style.colour).style("fill", style.filled ? style.colour : "var(--page)");
}

// The domain of a logarithmic axis for some values, with a margin.
function logDomain(values) {
  const [low, high] = d3.extent(values);
  if (low === undefined) return [1, 10];
  return low === high ? [low / 2, high * 2] : [low / 1.3, high * 1.3];
}

function decades([low, high]) {
  const digits = high / low < 200 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (const digit of digits) ticks.push(digit * 10 ** power);
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

function powersOfTwo([low, high]) {
  const ticks = [];
  const step = high / low > 64 ? 4 : 2;
  for (let tick = 2 ** Math.ceil(Math.log2(low)); tick <= high; tick *= step) ticks.push(tick);
  return ticks;
}

// Omits ticks that would overlap.
function spaced(ticks, scale, distance) {
  let last = -Infinity;
  return ticks.filter((tick) => {
    const far = Math.abs(scale(tick) - last) >= distance;
    if (far) last = scale(tick);
    return far;
  });
}

// chart: kind, title, machine, x and y {domain, ticks, format, title}, series [{variant,
// points: [{x, y, low, high, testCase}]}] with null points where a line breaks, gaps [{x, status,
// cases}], front: the points of the Pareto front, labels: [{x, y, text}], note, empty: the text of an
// empty chart.
function drawPanel(container, chart) {
  const gaps = chart.gaps || [];
  container.replaceChildren(titleOf(chart));
  if (!gaps.length && !chart.series.some((series) => series.points.some(Boolean))) {
    container.append(element("p", { class: "empty" }, chart.empty));
  } else {
    drawPlot(container, chart, gaps);
  }
  if (chart.note) container.append(element("p", { class: "muted note" }, chart.note));
}

function titleOf(chart) {
  const title = element("h4", {}, chart.title);
  if (machines.length > 1) title.append(element("div", { class: "muted" }, machines[chart.machine].name));
  return title;
}

function drawPlot(container, chart, gaps) {
  const width = Math.max(260, container.clientWidth);
  const statuses = distinct(gaps.map((gap) => gap.status));
  const margin = { left: 64, right: 14, top: 10, bottom: 36 + 16 * statuses.length };
  const height = Math.round(Math.min(300, width * 0.62)) + 16 * statuses.length;
  const x = d3.scaleLog(chart.x.domain, [margin.left, width - margin.right]);
  const y = d3.scaleLog(chart.y.domain, [height - margin.bottom, margin.top]);
  const svg = d3.create("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("role", "group")
    .attr("aria-label", `${chart.kind}, ${chart.title}, ${machines[chart.machine].name}`);
  drawAxes(svg, chart, { x, y, width, height, margin });
  const targets = [];
  const path = d3.line().defined(Boolean).x((point) => x(point.x)).y((point) => y(point.y));
  if (chart.front) {
    svg.append("path").attr("class", "front")
      .attr("d", path.curve(d3.curveStepAfter)(chart.front));
  }
  const clamp = (value) => Math.min(height - margin.bottom, Math.max(margin.top, y(value)));
  for (const series of chart.series) {
    const style = styles.get(series.variant);
    const group = svg.append("g").attr("class", series.variant === pinned ? "series highlighted" : "series").attr("data-variant", series.variant);
    if (chart.lines) {
      group.append("path").attr("class", "line").style("stroke", style.colour)
        .style("stroke-dasharray", style.dash)
        .attr("d", path.curve(d3.curveLinear)(series.points));
    }
    for (const point of series.points.filter(Boolean)) {
      const at = [x(point.x), y(point.y)];
      if (point.high) {
        group.append("path").attr("class", "interval").style("stroke", style.colour)
          .attr("d", `M${at[0]},${point.low > 0 ? clamp(point.low) : clamp(chart.y.domain[0])}V${clamp(point.high)}`);
      }
      const node = drawSymbol(group, style).attr("transform", `translate(${at})`).node();
      targets.push({ node, at, series: series.variant, cases: [point.testCase], lines: caseLines(point.testCase) });
    }
  }
  for (const { x: atX, y: atY, text } of chart.labels || []) {  // the area below and left of the front is free
    const room = x(atX) - margin.left > 7 * text.length;
    svg.append("text").attr("class", "point-label").attr("x", x(atX) + (room ? -6 : 0)).attr("y", y(atY) + 16)
      .attr("text-anchor", room ? "end" : "start").text(text);
  }
  drawGaps(svg, chart, statuses, { x, width, height, margin }, targets);
  container.append(svg.node());
  addInteraction(svg.node(), targets);
}

function drawAxes(svg, { x: xAxis, y: yAxis }, { x, y, width, height, margin }) {
  const bottom = height - margin.bottom;
  const axes = svg.append("g").attr("class", "axes").attr("aria-hidden", "true");
  for (const tick of spaced(yAxis.ticks, y, 22)) {
    axes.append("path").attr("class", "grid").attr("d", `M${margin.left},${y(tick)}H${width - margin.right}`);
    axes.append("text").attr("x", margin.left - 7).attr("y", y(tick)).attr("dy", "0.32em")
      .attr("text-anchor", "end").text(yAxis.format(tick));
  }
  for (const tick of spaced(xAxis.ticks, x, 44)) {
    axes.append("path").attr("class", "grid").attr("d", `M${x(tick)},${margin.top}V${bottom}`);
    axes.append("text").attr("x", x(tick)).attr("y", bottom + 15).attr("text-anchor", "middle")
      .text(xAxis.format(tick));
  }
  axes.append("path").attr("class", "domain").attr("d", `M${margin.left},${bottom}H${width - margin.right}`);
  axes.append("text").attr("class", "axis-title").attr("x", (margin.left + width - margin.right) / 2).attr("y", bottom + 30)
    .attr("text-anchor", "middle").text(xAxis.title);
}

// A row per status with the number of cases at each x.
function drawGaps(svg, chart, statuses, { x, height, margin }, targets) {
  statuses.forEach((status, row) => {
    const at = height - margin.bottom + 42 + 16 * row;
    svg.append("text").attr("class", `gap-title ${status}`).attr("x", margin.left - 7).attr("y", at)
      .attr("dy", "0.32em").attr("text-anchor", "end").text(ownProperty(kShortStatus, status) || status);
    for (const gap of chart.gaps.filter((other) => other.status === status)) {
      const node = svg.append("text").attr("class", `gap ${status}`).attr("x", x(gap.x)).attr("y", at)
        .attr("dy", "0.32em").attr("text-anchor", "middle").text(`${ownProperty(kStatusMarks, status) || "!"}\u202f${gap.cases.length}`)
        .node();
      targets.push({
        node, at: [x(gap.x), at], series: status, cases: gap.cases,
        lines: gap.cases.length === 1 ? caseLines(gap.cases[0])
          : [`${status}: ${plural(gap.cases.length, "case")}`, ...gap.cases.slice(0, 8).map(nameOf),
             ...(gap.cases.length > 8 ? [`and ${gap.cases.length - 8} more`] : [])],
      });
    }
  });
}

const kShortStatus = { unsupported: "unsupp.", mismatch: "mismatch", timeout: "timeout", error: "error" };

function addInteraction(svg, targets) {
  let current = null;
  const enter = (target) => {
    if (current && current !== target) leave();
    current = target;
    target.node.classList.add("highlighted");
  };
  const leave = () => {
    if (current) current.node.classList.remove("highlighted");
    current = null;
    hideTooltip();
  };
  targets.forEach((target, i) => {
    target.node.setAttribute("tabindex", i === 0 ? 0 : -1);
    target.node.setAttribute("role", "button");
    target.node.setAttribute("aria-label", target.lines.map((line) => line.textContent || line).join(", "));
    target.node.addEventListener("focus", () => {
      targets.forEach((other) => other.node.setAttribute("tabindex", other === target ? 0 : -1));
      enter(target);
      showTooltipAt(target.node, target.lines);
    });
    target.node.addEventListener("blur", leave);
  });
  svg.addEventListener("keydown", (event) => {
    const here = targets.find((target) => target.node === document.activeElement);
    if (!here) return;
    if (event.key === "Enter" || event.key === " ") showDetails(here.cases);
    else if (!event.key.startsWith("Arrow")) return;
    else {
      const next = neighbour(targets, here, event.key);
      if (next) next.node.focus();
    }
    event.preventDefault();
  });
  const find = (event) => {
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    const [px, py] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    const distance = (target) => Math.hypot(target.across ? 0 : target.at[0] - px, target.at[1] - py);
    const nearest = targets[d3.scan(targets, (a, b) => distance(a) - distance(b))];
    return nearest && distance(nearest) < kHitRadius ? nearest : null;
  };
  svg.addEventListener("pointermove", (event) => {
    const found = find(event);
    svg.classList.toggle("over", Boolean(found));
    if (!found) { leave(); return; }
    enter(found);
    showTooltip(found.node, found.lines, event.clientX, event.clientY);
  });
  svg.addEventListener("pointerleave", leave);
  svg.addEventListener("click", (event) => {
    const found = find(event);
    if (found) showDetails(found.cases);
  });
}

// Left and right prefer points of the same series, up and down points at the same x.
function neighbour(targets, here, key) {
  const along = key === "ArrowLeft" || key === "ArrowRight";
  const sign = key === "ArrowRight" || key === "ArrowDown" ? 1 : -1;
  const axis = along ? 0 : 1;
  const ahead = targets.filter((target) => target !== here && sign * (target.at[axis] - here.at[axis]) > 0);
  const preferred = ahead.filter((target) => (along ? target.series === here.series
    : Math.abs(target.at[0] - here.at[0]) < 1));
  const candidates = preferred.length ? preferred : ahead;
  const distance = (target) => Math.hypot(target.at[0] - here.at[0], target.at[1] - here.at[1]);
  return candidates[d3.scan(candidates, (a, b) => distance(a) - distance(b))];
}

// A button per series with its name and symbol. Hovering, focus or a click highlights the series.
function drawLegend(variants) {
  const families = d3.nest().key((variant) => styles.get(variant).colour).entries(variants);
  return element("div", { class: "legend", role: "group", "aria-label": "Legend" }, families.map((family) => (
    element("span", { class: "family" }, family.values.map((variant) => {
      const node = button("", () => pin(variant, node), { "aria-pressed": String(variant === pinned) });
      const svg = d3.select(node).append("svg").attr("viewBox", "-14 -8 28 16").attr("width", 28)
        .attr("height", 16).attr("aria-hidden", "true");
      const style = styles.get(variant);
      svg.append("path").attr("d", "M-13,0H13").attr("class", "line").style("stroke", style.colour)
        .style("stroke-dasharray", style.dash);
      drawSymbol(svg, style);
      node.append(variant);
      for (const [event, highlighted] of [["pointerenter", variant], ["focus", variant], ["pointerleave", null], ["blur", null]]) {
        node.addEventListener(event, () => highlight(highlighted || pinned));
      }
      return node;
    })))));
}

function pin(variant, pressed) {
  pinned = pinned === variant ? null : variant;
  for (const other of document.querySelectorAll(".legend button")) other.setAttribute("aria-pressed", "false");
  pressed.setAttribute("aria-pressed", String(pinned === variant));
  highlight(pinned);
}

function highlight(variant) {
  document.body.classList.toggle("highlighted", variant !== null);
  for (const series of document.querySelectorAll(".series")) {
    series.classList.toggle("highlighted", series.dataset.variant === variant);
  }
}

// A grid of charts: a row per series (scene, object type, setting), a column per machine.
function drawGrid(body, seriesNames, draw) {
  const shownMachines = machinesShown();
  body.append(element("div", { class: `charts ${shownMachines.length > 1 ? "by-machine" : ""}` }, seriesNames.flatMap((series) => (
    shownMachines.map((machine) => {
      const panel = element("figure", { class: "panel-chart" });
      drawWhenVisible(panel, () => draw(panel, series, machine));
      return panel;
    })))));
  body.querySelector(".charts").style.setProperty("--machines", shownMachines.length);
}

function machinesShown() {
  return distinct(shown.map((c) => c.machine)).sort((a, b) => a - b);
}
