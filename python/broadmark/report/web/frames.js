// Time by frame: the timeline of a selected case.

function drawFrames(body) {
  const timed = shown.filter((c) => c.frames_run > 0);
  body.replaceChildren();
  if (!timed.length) { body.append(element("p", { class: "empty" }, "No case with times matches the filters.")); return; }
  if (!timed.includes(view.chosen)) view.chosen = defaultCase(timed);
  const chosen = view.chosen;
  const here = timed.filter((c) => c.machine === chosen.machine);
  const candidates = here.filter((c) => c.recording === chosen.recording).sort((a, b) => isSelfCheck(a) - isSelfCheck(b));
  const select = (list, casesOf) => (i) => {
    const matching = casesOf(list[i]);
    view.chosen = matching.find((c) => c.variant === chosen.variant) || matching[0];
    drawFrames(body);
  };
  const allMachines = machinesShown().filter((machine) => timed.some((c) => c.machine === machine));
  const allRecordings = distinct(here.map((c) => c.recording)).sort(byRecording);
  const row = element("div", { class: "row choices" });
  if (allMachines.length > 1) {
    row.append(choice("Machine", allMachines.map((machine) => machines[machine].name), allMachines.indexOf(chosen.machine),
      select(allMachines, (machine) => preferSame(timed.filter((c) => c.machine === machine), chosen))));
  }
  row.append(
    choice("Recording", allRecordings.map((recording) => recording.title), allRecordings.indexOf(chosen.recording),
           select(allRecordings, (recording) => here.filter((c) => c.recording === recording))),
    choice("Case", candidates.map((c) => (c.superseded ? `${c.variant} (${c.file}, run again later)` : c.variant)),
           candidates.indexOf(chosen), (i) => { view.chosen = candidates[i]; drawFrames(body); }),
    button("Details", () => showDetails([view.chosen])));
  const figure = element("figure", {});
  body.append(row, figure);
  drawTimeline(figure, chosen);
}

function preferSame(candidates, chosen) {
  const same = candidates.filter((c) => c.recording === chosen.recording);
  return same.length ? same : candidates;
}

// The fastest case on the largest recording.
function defaultCase(candidates) {
  const largest = d3.max(candidates, (c) => c.recording.objects);
  const largestCases = candidates.filter((c) => c.recording.objects === largest && !isSelfCheck(c));
  const timed = largestCases.filter(isTimed).sort((a, b) => a[view.measure] - b[view.measure]);
  return timed[0] || largestCases[0] || candidates[0];
}
