// Charts of points: logarithmic axes, lines, intervals, gaps below the plot. All points of a chart are
// one stop of the Tab key; arrow keys go on from there.

const kSymbols = [d3.symbolCircle, d3.symbolSquare, d3.symbolTriangle, d3.symbolDiamond, d3.symbolStar,
                  d3.symbolWye, d3.symbolCross];
const kDashes = ["", "6 3", "2 3", "9 3 2 3"];
let pinned = null;  // the variant whose button in a legend is pressed

const kReach = 26;  // pixels from which the pointer finds a point

// Colour: family; shape: algorithm among those of a colour; solid: several threads; dashes: parameters.
const styles = new Map();
{
  const algorithms = new Map(Object.values(data.curves).map((curve) => [curve, []]));
  const alike = new Map();
  for (const one of cases) {
    if (styles.has(one.variant)) continue;
    const curve = data.curves[one.family];
    const sharing = algorithms.get(curve);
    if (!sharing.includes(one.algorithm)) sharing.push(one.algorithm);
    const symbol = sharing.indexOf(one.algorithm) % kSymbols.length;
    const key = `${curve} ${symbol} ${one.threads > 1}`;
    alike.set(key, (alike.get(key) ?? -1) + 1);
    styles.set(one.variant, {
      colour: `var(--curve-${curve})`,
      symbol: kSymbols[symbol],
      solid: one.threads > 1,
      dash: kDashes[alike.get(key) % kDashes.length],
    });
  }
}

function drawSymbol(node, style) {
  return node.append("path").attr("class", "symbol")
    .attr("d", d3.symbol().type(style.symbol).size(46)())
    .style("stroke", style.colour).style("fill", style.solid ? style.colour : "var(--page)");
}

// The part of a logarithmic axis that values need, rounded outward.
function logDomain(values) {
  const [low, high] = d3.extent(values);
  if (low === undefined) return [1, 10];
  return low === high ? [low / 2, high * 2] : [low / 1.3, high * 1.3];
}

function decades([low, high]) {
  const few = high / low < 200 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power) {
    for (const digit of few) ticks.push(digit * 10 ** power);
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

function powersOfTwo([low, high]) {
  const ticks = [];
  const step = high / low > 64 ? 4 : 2;
  for (let tick = 2 ** Math.ceil(Math.log2(low)); tick <= high; tick *= step) ticks.push(tick);
  return ticks;
}

// Leaves out ticks that would overlap.
function spaced(ticks, scale, distance) {
  let last = -Infinity;
  return ticks.filter((tick) => {
    const far = Math.abs(scale(tick) - last) >= distance;
    if (far) last = scale(tick);
    return far;
  });
}

// chart: kind, title, machine, x and y {domain, ticks, format, title}, series [{variant,
// points: [{x, y, low, high, one}]}] with null points where a line breaks, gaps [{x, status, cases}],
// front: points joined by a line of their own, labels: [{x, y, text}], note, empty: what to say if there
// is nothing to draw.
function drawPanel(container, chart) {
  const title = element("h4", {}, chart.title);
  if (machines.length > 1) title.append(element("div", { class: "muted" }, machines[chart.machine].name));
  const gaps = chart.gaps || [];
  container.replaceChildren(title);
  if (!gaps.length && !chart.series.some((series) => series.points.some(Boolean))) {
    container.append(element("p", { class: "empty" }, chart.empty));
  } else {
    drawPlot(container, chart, gaps);
  }
  if (chart.note) container.append(element("p", { class: "muted note" }, chart.note));
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
    const group = svg.append("g").attr("class", series.variant === pinned ? "series lit" : "series").attr("data-variant", series.variant);
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
      targets.push({ node, at, series: series.variant, cases: [point.one], lines: caseLines(point.one) });
    }
  }
  for (const { x: atX, y: atY, text } of chart.labels || []) {  // below and left of the front is nothing
    const room = x(atX) - margin.left > 7 * text.length;
    svg.append("text").attr("class", "point-label").attr("x", x(atX) + (room ? -6 : 0)).attr("y", y(atY) + 16)
      .attr("text-anchor", room ? "end" : "start").text(text);
  }
  drawGaps(svg, chart, statuses, { x, width, height, margin }, targets);
  container.append(svg.node());
  makeReachable(svg.node(), targets);
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

// One row for each status: how many have it, at each place.
function drawGaps(svg, chart, statuses, { x, height, margin }, targets) {
  statuses.forEach((status, row) => {
    const at = height - margin.bottom + 42 + 16 * row;
    svg.append("text").attr("class", `gap-title ${status}`).attr("x", margin.left - 7).attr("y", at)
      .attr("dy", "0.32em").attr("text-anchor", "end").text(ownOf(kShortStatus, status) || status);
    for (const gap of chart.gaps.filter((one) => one.status === status)) {
      const node = svg.append("text").attr("class", `gap ${status}`).attr("x", x(gap.x)).attr("y", at)
        .attr("dy", "0.32em").attr("text-anchor", "middle").text(`${ownOf(kStatusMarks, status) || "!"}\u202f${gap.cases.length}`)
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

function makeReachable(svg, targets) {
  let current = null;
  const enter = (target) => {
    if (current && current !== target) leave();
    current = target;
    target.node.classList.add("lit");
  };
  const leave = () => {
    if (current) current.node.classList.remove("lit");
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
    const away = (target) => Math.hypot(target.at[0] - px, target.at[1] - py);
    const nearest = targets[d3.scan(targets, (a, b) => away(a) - away(b))];
    return nearest && away(nearest) < kReach ? nearest : null;
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

// Left and right: along a line; up and down: the next above or below at the same place, or anywhere.
function neighbour(targets, here, key) {
  const along = key === "ArrowLeft" || key === "ArrowRight";
  const sign = key === "ArrowRight" || key === "ArrowDown" ? 1 : -1;
  const axis = along ? 0 : 1;
  const ahead = targets.filter((one) => one !== here && sign * (one.at[axis] - here.at[axis]) > 0);
  const preferred = ahead.filter((one) => (along ? one.series === here.series
    : Math.abs(one.at[0] - here.at[0]) < 1));
  const some = preferred.length ? preferred : ahead;
  const away = (one) => Math.hypot(one.at[0] - here.at[0], one.at[1] - here.at[1]);
  return some[d3.scan(some, (a, b) => away(a) - away(b))];
}

// A button for each series: its name and sign; pointed at or pressed it stands out in all charts.
function drawLegend(variants) {
  const families = d3.nest().key((variant) => styles.get(variant).colour).entries(variants);
  return element("div", { class: "legend", role: "group", "aria-label": "Legend" }, families.map((family) => (
    element("span", { class: "family" }, family.values.map((variant) => {
      const made = button("", () => pin(variant, made), { "aria-pressed": String(variant === pinned) });
      const svg = d3.select(made).append("svg").attr("viewBox", "-14 -8 28 16").attr("width", 28)
        .attr("height", 16).attr("aria-hidden", "true");
      const style = styles.get(variant);
      svg.append("path").attr("d", "M-13,0H13").attr("class", "line").style("stroke", style.colour)
        .style("stroke-dasharray", style.dash);
      drawSymbol(svg, style);
      made.append(variant);
      for (const [event, lit] of [["pointerenter", variant], ["focus", variant], ["pointerleave", null], ["blur", null]]) {
        made.addEventListener(event, () => highlight(lit || pinned));
      }
      return made;
    })))));
}

function pin(variant, made) {
  pinned = pinned === variant ? null : variant;
  for (const other of document.querySelectorAll(".legend button")) other.setAttribute("aria-pressed", "false");
  made.setAttribute("aria-pressed", String(pinned === variant));
  highlight(pinned);
}

function highlight(variant) {
  document.body.classList.toggle("lit", variant !== null);
  for (const series of document.querySelectorAll(".series")) {
    series.classList.toggle("lit", series.dataset.variant === variant);
  }
}

// The charts of some series (scene, object type, setting): a row each, a column per machine.
function drawGrid(body, serieses, draw) {
  const wanted = machinesShown();
  body.append(element("div", { class: `charts ${wanted.length > 1 ? "by-machine" : ""}` }, serieses.flatMap((series) => (
    wanted.map((machine) => {
      const panel = element("figure", { class: "panel-chart" });
      drawWhenSeen(panel, () => draw(panel, series, machine));
      return panel;
    })))));
  body.querySelector(".charts").style.setProperty("--machines", wanted.length);
}

function machinesShown() {
  return distinct(shown.map((one) => one.machine)).sort((a, b) => a - b);
}
