// Time against memory: a chart for each scene, object type and machine, at one number of bodies.

let bodiesChosen = null;
const kLeastBytes = 4096;  // a page: what did not grow stands here

function drawMemory(body) {
  const some = shown.filter((one) => !one.superseded && !isSelfCheck(one));
  body.replaceChildren();
  const sizes = distinct(some.map((one) => one.on.objects)).sort((a, b) => a - b);
  if (!sizes.length) { body.append(element("p", { class: "empty" }, "No case is left by the filters.")); return; }
  const chosen = sizes.includes(bodiesChosen) ? bodiesChosen : sizes[sizes.length - 1];
  body.append(choice("Bodies", sizes.map((size) => count(size)), sizes.indexOf(chosen),
                     (i) => { bodiesChosen = sizes[i]; refresh(); }));
  const here = some.filter((one) => one.on.objects === chosen);
  const isDrawn = (one) => isTimed(one) && one.peak_bytes !== null;
  const drawn = here.filter(isDrawn);
  const place = (one) => ({ x: Math.max(kLeastBytes, one.peak_bytes), y: one[view.measure], one });
  const xDomain = logDomain(drawn.map((one) => place(one).x));
  const [low, high] = logDomain(drawn.map((one) => one[view.measure]));
  const yDomain = [low / 1.4, high];  // room for names
  const x = { domain: xDomain, ticks: powersOfTwo(xDomain), format: (tick) => shortUnit(tick, kSizes), title: "memory" };
  const y = { domain: yDomain, ticks: decades(yDomain), format: (tick) => shortUnit(tick, kTimes) };
  const variants = distinct(drawn.map((one) => one.variant));
  body.append(element("details", { class: "more", open: view.printing || variants.length <= 14 },
                      element("summary", {}, `Legend (${variants.length})`), drawLegend(variants)));
  const serieses = distinct(here.sort((a, b) => byRecording(a.on, b.on)).map((one) => one.on.series));
  drawGrid(body, serieses, (panel, series, machine) => {
    const own = here.filter((one) => one.on.series === series && one.machine === machine);
    const points = own.filter(isDrawn).map(place);
    const front = frontOf(points);
    drawPanel(panel, {
      kind: "Time against memory", title: series, machine, x, y,
      series: points.map((point) => ({ variant: point.one.variant, points: [point] })), front,
      labels: spacedLabels(front), note: leftOut(own.filter((one) => !isDrawn(one))), empty: "Nothing with time and memory here.",
    });
  });
}

// Those with less time or less memory than any other.
function frontOf(points) {
  let least = Infinity;
  return points.sort((a, b) => a.x - b.x || a.y - b.y).filter((point) => {
    if (point.y >= least) return false;
    least = point.y;
    return true;
  });
}

function spacedLabels(front) {
  let last = null;
  return front.slice().reverse().filter((point) => {
    const far = !last || point.y / last.y > 1.35 || last.x / point.x > 6;
    if (far) last = point;
    return far;
  }).map((point) => ({ x: point.x, y: point.y, text: point.one.variant }));
}

function leftOut(some) {
  const reasons = d3.nest().key((one) => (one.status !== "ok" ? one.status : "memory not measured")).entries(some);
  return reasons.length
    ? `Not in the chart: ${reasons.map(({ key, values }) => `${values.length} ${key}`).join(", ")}.` : "";
}
