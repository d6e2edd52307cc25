// Frame by frame: the timeline of a chosen case.

function drawFrames(body) {
  const some = shown.filter((one) => one.frames_run > 0);
  body.replaceChildren();
  if (!some.length) { body.append(element("p", { class: "empty" }, "No case with times is left by the filters.")); return; }
  if (!some.includes(view.chosen)) view.chosen = defaultCase(some);
  const chosen = view.chosen;
  const here = some.filter((one) => one.machine === chosen.machine);
  const on = here.filter((one) => one.recording === chosen.recording);
  const pick = (list, same) => (i) => {
    const wanted = same(list[i]);
    view.chosen = wanted.find((one) => one.variant === chosen.variant) || wanted[0];
    drawFrames(body);
  };
  const allMachines = machinesShown().filter((machine) => some.some((one) => one.machine === machine));
  const allRecordings = distinct(here.map((one) => one.on)).sort(byRecording);
  const row = element("div", { class: "row choices" });
  if (allMachines.length > 1) {
    row.append(choice("Machine", allMachines.map((machine) => machines[machine].name), allMachines.indexOf(chosen.machine),
      pick(allMachines, (machine) => preferSame(some.filter((one) => one.machine === machine), chosen))));
  }
  row.append(
    choice("Recording", allRecordings.map((one) => one.title), allRecordings.indexOf(chosen.on),
           pick(allRecordings, (on) => here.filter((one) => one.on === on))),
    choice("Case", on.map((one) => (one.superseded ? `${one.variant} (${one.file}, run again later)` : one.variant)),
           on.indexOf(chosen), (i) => { view.chosen = on[i]; drawFrames(body); }),
    button("Details", () => showDetails([view.chosen])));
  const figure = element("figure", {});
  body.append(row, figure);
  drawTimeline(figure, chosen);
}

function preferSame(some, chosen) {
  const same = some.filter((one) => one.recording === chosen.recording);
  return same.length ? same : some;
}

// The fastest on the largest recording.
function defaultCase(some) {
  const largest = d3.max(some, (one) => one.on.objects);
  const there = some.filter((one) => one.on.objects === largest && !isSelfCheck(one));
  const timed = there.filter(isTimed).sort((a, b) => a[view.measure] - b[view.measure]);
  return timed[0] || there[0] || some[0];
}
