// Time against memory: a chart per scene, object type and machine, for one number of bodies.

let selectedBodies = null;
const kMinBytes = 4096;  // a memory page; smaller values are drawn here

function drawMemory(body) {
  const current = shown.filter((c) => !c.superseded && !isSelfCheck(c));
  body.replaceChildren();
  const sizes = distinct(current.map((c) => c.recording.objects)).sort((a, b) => a - b);
  if (!sizes.length) { body.append(element("p", { class: "empty" }, "No case matches the filters.")); return; }
  const size = sizes.includes(selectedBodies) ? selectedBodies : sizes[sizes.length - 1];
  body.append(choice("Bodies", sizes.map((bodies) => count(bodies)), sizes.indexOf(size),
                     (i) => { selectedBodies = sizes[i]; refresh(); }));
  const sizeCases = current.filter((c) => c.recording.objects === size);
  const isDrawn = (c) => isTimed(c) && c.peak_bytes !== null;
  const drawn = sizeCases.filter(isDrawn);
  const pointOf = (c) => ({ x: Math.max(kMinBytes, c.peak_bytes), y: c[view.measure], testCase: c });
  const xDomain = logDomain(drawn.map((c) => pointOf(c).x));
  const [low, high] = logDomain(drawn.map((c) => c[view.measure]));
  const yDomain = [low / 1.4, high];  // room for labels
  const x = { domain: xDomain, ticks: powersOfTwo(xDomain), format: (tick) => shortUnit(tick, kSizes), title: "peak memory" };
  const y = { domain: yDomain, ticks: decades(yDomain), format: (tick) => shortUnit(tick, kTimes) };
  const variants = distinct(drawn.map((c) => c.variant));
  body.append(element("details", { class: "more", open: view.printing || variants.length <= 14 },
                      element("summary", {}, `Legend (${variants.length})`), drawLegend(variants)));
  const seriesNames = distinct(sizeCases.sort((a, b) => byRecording(a.recording, b.recording)).map((c) => c.recording.series));
  drawGrid(body, seriesNames, (panel, series, machine) => {
    const panelCases = sizeCases.filter((c) => c.recording.series === series && c.machine === machine);
    const points = panelCases.filter(isDrawn).map(pointOf);
    const front = paretoFront(points);
    drawPanel(panel, {
      kind: "Time against memory", title: series, machine, x, y,
      series: points.map((point) => ({ variant: point.testCase.variant, points: [point] })), front,
      labels: spacedLabels(front), note: omissionNote(panelCases.filter((c) => !isDrawn(c))), empty: "No case with time and memory.",
    });
  });
}

// The Pareto front of time and memory.
function paretoFront(points) {
  let minY = Infinity;
  return points.sort((a, b) => a.x - b.x || a.y - b.y).filter((point) => {
    if (point.y >= minY) return false;
    minY = point.y;
    return true;
  });
}

function spacedLabels(front) {
  let last = null;
  return front.slice().reverse().filter((point) => {
    const far = !last || point.y / last.y > 1.35 || last.x / point.x > 6;
    if (far) last = point;
    return far;
  }).map((point) => ({ x: point.x, y: point.y, text: point.testCase.variant }));
}

function omissionNote(omitted) {
  const reasons = d3.nest().key((c) => (c.status !== "ok" ? c.status : "memory not measured")).entries(omitted);
  return reasons.length
    ? `Not shown: ${reasons.map(({ key, values }) => `${values.length} ${key}`).join(", ")}.` : "";
}
