// The frames of a case: stacked phases, and the pairs below.

function drawTimeline(container, testCase) {
  const line = timelineOf(testCase);
  if (!line) {
    container.replaceChildren(element("p", { class: "empty" }, `No frame was timed: ${testCase.reason || testCase.status}.`));
    return;
  }
  const { points } = line;
  const frames = testCase.frames_run;
  const phases = kPhases.map(([, name], i) => ({ name, i, values: line.phases[i] }))
    .filter((phase) => d3.max(phase.values) > 0);
  const totals = Array.from({ length: points }, (_, p) => d3.sum(phases, (phase) => phase.values[p]));
  const width = Math.max(280, container.clientWidth);
  const plot = { left: 58, right: width - 12, top: 8, bottom: 190 };
  const pairsPlot = { top: 208, bottom: 250 };
  const x = d3.scaleLinear([1, frames + 1], [plot.left, plot.right]);
  const y = d3.scaleLinear([0, d3.max(totals) * 1.05 || 1], [plot.bottom, plot.top]).nice(4);
  const svg = d3.create("svg").attr("viewBox", `0 0 ${width} 276`).attr("class", "timeline")
    .attr("tabindex", 0).attr("role", "img");
  const edge = (p) => 1 + p * frames / points;

  for (const tick of y.ticks(4)) {
    svg.append("path").attr("class", "grid").attr("d", `M${plot.left},${y(tick)}H${plot.right}`);
    axisText(svg, plot.left - 7, y(tick), "end", shortUnit(tick * 1e-9, kTimes).replace(/^0\s.*/, "0"));
  }
  const below = new Float64Array(points);
  for (const phase of phases) {
    const low = Float64Array.from(below);
    phase.values.forEach((value, p) => { below[p] += value; });
    const steps = d3.range(points + 1);
    const at = (p) => Math.min(p, points - 1);
    svg.append("path").attr("class", "phase").style("fill", `var(--phase-${phase.i})`)
      .attr("d", d3.area().x((p) => x(edge(p))).y0((p) => y(low[at(p)])).y1((p) => y(below[at(p)]))
        .curve(d3.curveStepAfter)(steps));
  }
  drawPairs(svg, line, { x, edge, plot, pairsPlot, frames });
  for (const frame of testCase.wrong_frames) {
    svg.append("path").attr("class", "wrong").attr("d", `M${x(frame) - 4},${plot.bottom + 9}l4,-8l4,8z`)
      .append("title").text(`wrong answer in frame ${frame}`);
  }
  addCursor(svg, { x, edge, points, plot, pairsPlot, frames, lines: (p) => pointLines(testCase, line, phases, totals, p) });
  const binning = frames > points ? `, in ${points} points, each the mean of about ${Math.round(frames / points)} frames` : "";
  const median = testCase.repetitions > 1 ? `, median of ${testCase.repetitions} repetitions` : "";
  const wrong = testCase.wrong_frames.length ? ` ▲ ${plural(testCase.wrong_frames.length, "frame")} with a wrong answer.` : "";
  svg.attr("aria-label", `Frames of ${fullName(testCase)}: ${phases.map((phase) => (
    `${phase.name} ${time(d3.mean(phase.values) * 1e-9)}`)).join(", ")}`);
  container.replaceChildren(
    element("p", { class: "phases" }, phases.map((phase) => element("span", {}, swatch(phase.i), ` ${phase.name} `,
      element("span", { class: "muted" }, time(d3.mean(phase.values) * 1e-9))))),
    svg.node(), element("p", { class: "muted note" }, `${plural(frames, "frame")}${binning}${median}.${wrong}`));
}

function swatch(phase) {
  const node = element("span", { class: "swatch" });
  node.style.setProperty("background", `var(--phase-${phase})`);
  return node;
}

function axisText(svg, x, y, anchor, text) {
  svg.append("text").attr("x", x).attr("y", y).attr("dy", "0.32em").attr("text-anchor", anchor).text(text);
}

function drawPairs(svg, line, { x, edge, plot, pairsPlot, frames }) {
  const maxPairs = d3.max(line.pairs.filter(Number.isFinite));
  for (const tick of spaced(x.ticks(Math.min(8, frames)).filter(Number.isInteger), x, 40)) {
    axisText(svg, x(tick + 0.5), pairsPlot.bottom + 15, "middle", count(tick));
  }
  axisText(svg, plot.left - 7, pairsPlot.bottom + 15, "end", "frame");
  svg.append("path").attr("class", "domain").attr("d", `M${plot.left},${pairsPlot.bottom}H${plot.right}`);
  svg.append("path").attr("class", "domain").attr("d", `M${plot.left},${plot.bottom}H${plot.right}`);
  if (maxPairs === undefined) { axisText(svg, plot.left + 4, pairsPlot.top + 20, "start", "pairs unknown"); return; }
  const y = d3.scaleLinear([0, maxPairs || 1], [pairsPlot.bottom, pairsPlot.top]);
  axisText(svg, plot.left - 7, pairsPlot.top + 3, "end", d3.format(".3~s")(maxPairs));
  axisText(svg, plot.left - 7, pairsPlot.bottom - 3, "end", "pairs");
  svg.append("path").attr("class", "pairs")
    .attr("d", d3.line().x((p) => x(edge(p + 0.5))).y((p) => y(line.pairs[p]))(d3.range(line.points)));
}

function pointLines(testCase, line, phases, totals, p) {
  const frames = testCase.frames_run;
  const first = Math.floor(p * frames / line.points) + 1;
  const last = Math.floor((p + 1) * frames / line.points);
  return [first >= last ? `frame ${first}` : `frames ${first} to ${last}`, `total ${time(totals[p] * 1e-9)}`,
          ...phases.slice().reverse().map((phase) => `${phase.name} ${time(phase.values[p] * 1e-9)}`),
          ...(Number.isFinite(line.pairs[p]) ? [`${plural(Math.round(line.pairs[p]), "pair")}`] : [])];
}

// A cursor that follows the pointer or the arrow keys.
function addCursor(svg, { x, edge, points, plot, pairsPlot, frames, lines }) {
  const node = svg.node();
  const cursor = svg.append("path").attr("class", "cursor");
  let at = 0;
  const moveTo = (p) => {
    at = Math.max(0, Math.min(points - 1, p));
    cursor.attr("d", `M${x(edge(at + 0.5))},${plot.top}V${pairsPlot.bottom}`);
  };
  const leave = () => { cursor.attr("d", null); hideTooltip(); };
  const showHere = () => {
    moveTo(at);
    const box = node.getBoundingClientRect();
    showTooltip(node, lines(at), box.left + x(edge(at + 0.5)) * box.width / node.viewBox.baseVal.width, box.top + 60);
    announce(lines(at).join(", "));
  };
  node.addEventListener("pointermove", (event) => {
    const box = node.getBoundingClientRect();
    const px = (event.clientX - box.left) * node.viewBox.baseVal.width / box.width;
    moveTo(Math.floor((x.invert(px) - 1) / frames * points));
    showTooltip(node, lines(at), event.clientX, event.clientY);
  });
  node.addEventListener("pointerleave", leave);
  node.addEventListener("blur", leave);
  node.addEventListener("focus", showHere);
  node.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1, Home: -points, End: points }[event.key];
    if (!step) return;
    event.preventDefault();
    moveTo(at + step);
    showHere();
  });
}
