// Time over bodies: a chart per scene, object type and machine, all with the same axes. With a
// single number of bodies: a row per variant.

function drawScaling(body) {
  const latest = shown.filter((c) => !c.superseded && !isSelfCheck(c));
  body.replaceChildren();
  if (!latest.length) { body.append(element("p", { class: "empty" }, "No case matches the filters.")); return; }
  const variants = drawnVariants(latest, body);
  const timed = latest.filter((c) => isTimed(c) && variants.has(c.variant));
  const objects = distinct(latest.map((c) => c.recording.objects)).filter((n) => n > 0).sort((a, b) => a - b);
  const x = { domain: logDomain(objects), ticks: objects, format: d3.format("~s"), title: "bodies" };
  const yDomain = logDomain(timed.map((c) => c[view.measure]));
  const y = { domain: yDomain, ticks: decades(yDomain), format: (tick) => shortUnit(tick, kTimes) };
  const bySeries = d3.nest().key((c) => c.recording.series).entries(latest.slice().sort((a, b) => byRecording(a.recording, b.recording)));
  const single = new Set(bySeries.filter(({ values }) => distinct(values.map((c) => c.recording.objects)).length === 1).map(({ key }) => key));
  if (single.size < bySeries.length) body.append(drawLegend([...variants].filter((variant) => latest.some((c) => c.variant === variant))));
  const without = timed.filter((c) => !hasInterval(c)).length;
  if (without) {
    body.append(element("p", { class: "muted note" }, view.measure === "seconds_per_frame"
      ? `${without} of ${plural(timed.length, "point")} have a single repetition and therefore no interval.`
      : "Only means have intervals."));
  }
  drawGrid(body, bySeries.map((entry) => entry.key), (panel, series, machine) => {
    const panelCases = latest.filter((c) => c.recording.series === series && c.machine === machine && variants.has(c.variant));
    if (single.has(series)) {
      drawRows(panel, { kind: "Time per variant", title: panelCases.length ? panelCases[0].recording.title : series, machine, x: y, cases: panelCases });
      return;
    }
    drawPanel(panel, {
      kind: "Time over bodies", title: series, machine,
      x, y, lines: true, series: seriesOf(panelCases), gaps: gapsOf(panelCases), empty: "Not run on this machine.",
    });
  });
}

// All variants, or the best of each family, with buttons to choose.
function drawnVariants(latest, body) {
  const all = distinct(latest.map((c) => c.variant));
  const best = bestOfFamilies(machinesShown().map((machine) => rank(latest, machine)));
  if (all.length <= Math.max(best.size, 10)) return new Set(all);
  body.append(element("div", { class: "row choices", role: "group", "aria-label": "Variants" },
    ...[[false, `Best of each family (${best.size})`], [true, `All variants (${all.length})`]].map(([allVariants, text]) => (
      button(text, () => { view.allVariants = allVariants; refresh(); },
             { "aria-pressed": String(view.allVariants === allVariants), class: "toggle" })))));
  return view.allVariants ? new Set(all) : new Set(all.filter((variant) => best.has(variant)));
}

function seriesOf(panelCases) {
  return d3.nest().key((c) => c.variant).entries(panelCases).map(({ key, values }) => ({
    variant: key,
    points: values.sort((a, b) => a.recording.objects - b.recording.objects).map((c) => (!isTimed(c) ? null : {
      x: c.recording.objects, y: c[view.measure], testCase: c,
      low: hasInterval(c) ? c.ci95_low_seconds : 0, high: hasInterval(c) ? c.ci95_high_seconds : 0,
    })),
  }));
}

function gapsOf(panelCases) {
  return d3.nest().key((c) => c.status).key((c) => c.recording.objects)
    .entries(panelCases.filter((c) => c.status !== "ok"))
    .flatMap(({ key: status, values }) => values.map((entry) => ({ status, x: +entry.key, cases: entry.values })));
}
