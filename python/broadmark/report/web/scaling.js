// Time over bodies: a chart for each scene, object type and machine, all with the same axes.

function drawScaling(body) {
  const some = shown.filter((one) => !one.superseded);
  body.replaceChildren();
  if (!some.length) { body.append(element("p", { class: "empty" }, "No case is left by the filters.")); return; }
  const wanted = drawnVariants(some, body);
  const timed = some.filter((one) => isTimed(one) && wanted.has(one.variant));
  const objects = distinct(some.map((one) => one.on.objects)).filter((n) => n > 0).sort((a, b) => a - b);
  const x = { domain: logDomain(objects), ticks: objects, format: d3.format("~s"), title: "bodies" };
  const yDomain = logDomain(timed.map((one) => one[view.measure]));
  const y = { domain: yDomain, ticks: decades(yDomain), format: (tick) => shortUnit(tick, kTimes) };
  body.append(drawLegend([...wanted].filter((variant) => some.some((one) => one.variant === variant))));
  const without = timed.filter((one) => !hasInterval(one)).length;
  if (without) {
    body.append(element("p", { class: "muted note" }, view.measure === "seconds_per_frame"
      ? `${without} of ${plural(timed.length, "point")} have a single repetition and so no interval.`
      : "Intervals are known of the mean only."));
  }
  const bySeries = d3.nest().key((one) => one.on.series).entries(some.slice().sort((a, b) => byRecording(a.on, b.on)));
  drawGrid(body, bySeries.map((entry) => entry.key), (panel, series, machine) => {
    const own = some.filter((one) => one.on.series === series && one.machine === machine && wanted.has(one.variant));
    drawPanel(panel, {
      kind: "Time over bodies", title: series, machine,
      x, y, lines: true, series: seriesOf(own), gaps: gapsOf(own), empty: "Not run on this machine.",
    });
  });
}

// All variants, or of each family its best; says which, and lets choose.
function drawnVariants(some, body) {
  const every = distinct(some.map((one) => one.variant));
  const best = bestOfFamilies(machinesShown().map((machine) => rank(some, machine)));
  if (every.length <= Math.max(best.size, 10)) return new Set(every);
  body.append(element("div", { class: "row choices", role: "group", "aria-label": "Which variants" },
    ...[[false, `Best of each family (${best.size})`], [true, `All variants (${every.length})`]].map(([all, text]) => (
      button(text, () => { view.everyVariant = all; refresh(); },
             { "aria-pressed": String(view.everyVariant === all), class: "toggle" })))));
  return view.everyVariant ? new Set(every) : new Set(every.filter((variant) => best.has(variant)));
}

function seriesOf(own) {
  return d3.nest().key((one) => one.variant).entries(own).map(({ key, values }) => ({
    variant: key,
    points: values.sort((a, b) => a.on.objects - b.on.objects).map((one) => (!isTimed(one) ? null : {
      x: one.on.objects, y: one[view.measure], one,
      low: hasInterval(one) ? one.ci95_low_seconds : 0, high: hasInterval(one) ? one.ci95_high_seconds : 0,
    })),
  }));
}

function gapsOf(own) {
  return d3.nest().key((one) => one.status).key((one) => one.on.objects)
    .entries(own.filter((one) => one.status !== "ok"))
    .flatMap(({ key: status, values }) => values.map((at) => ({ status, x: +at.key, cases: at.values })));
}
