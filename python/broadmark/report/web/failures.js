// What has no right answer or no time, with the reason; and what was never run.

const kFailureColumns = [
  { title: "variant", value: nameOf, show: nameOf, rank: 1 },
  { title: "status", value: (one) => one.status, show: (one) => statusMark(one.status), rank: 1 },
  { title: "recording", value: (one) => one.on.title, show: (one) => one.on.title, rank: 1 },
  { title: "reason", value: (one) => one.reason, show: (one) => one.reason || kNothing, rank: 1 },
  ...kMachineColumns,
];

let failuresTable = null;

function drawFailures(body) {
  failuresTable = failuresTable || makeTable("Failures", kFailureColumns, 1);
  const failed = shown.filter((one) => one.status !== "ok");
  const unchecked = shown.filter((one) => one.status === "ok" && !one.checked && !isSelfCheck(one)).length;
  const unfinished = shown.filter((one) => one.status === "ok" && !one.complete).length;
  failuresTable.show(failed);
  body.replaceChildren(
    failed.length ? failuresTable.node
      : element("p", { class: "empty" }, shown.length ? "Every case shown has right answers and a time." : "No case is left by the filters."),
    ...(unchecked ? [element("p", { class: "notice" }, `The answers of ${plural(unchecked, "case")} were not checked.`)] : []),
    ...(unfinished ? [element("p", { class: "notice" }, `${plural(unfinished, "case")} ran fewer repetitions than asked for: the run was interrupted.`)] : []),
    ...gapLists());
}

// Variants that were not run on recordings on which others were, on the same machine.
function gapLists() {
  return machinesShown().flatMap((machine) => {
    const { rows, recordings: on } = rank(shown, machine);
    const gaps = rows.map((row) => ({ row, missing: row.cells.filter((cell) => !cell.one) }))
      .filter((gap) => gap.missing.length);
    if (!gaps.length) return [];
    const where = machines.length > 1 ? ` on ${machines[machine].name}` : "";
    return [element("details", { class: "more", open: view.printing },
      element("summary", {}, `Not run${where}: ${plural(gaps.length, "variant")} on some of ${plural(on.length, "recording")}`),
      element("ul", { class: "plain" }, gaps.map(({ row, missing }) => element("li", {}, element("b", {}, row.variant),
        missing.length > 6 ? `: on ${missing.length} of ${on.length} recordings`
          : `: ${missing.map((cell) => cell.recording.title).join("; ")}`))))];
  });
}
