// Cases with wrong answers or without a time, with the reasons, and gaps.

const kFailureColumns = [
  { title: "variant", value: nameOf, show: nameOf, rank: 1 },
  { title: "status", value: (c) => c.status, show: (c) => statusMark(c.status), rank: 1 },
  { title: "recording", value: (c) => c.recording.title, show: (c) => c.recording.title, rank: 1 },
  { title: "reason", value: (c) => c.reason, show: (c) => c.reason || kNoValue, rank: 1 },
  ...kMachineColumns,
];

let failuresTable = null;

function drawFailures(body) {
  failuresTable = failuresTable || makeTable("Failures", kFailureColumns, 1);
  const failed = shown.filter((c) => c.status !== "ok");
  const unchecked = shown.filter((c) => c.status === "ok" && !c.checked && !isSelfCheck(c)).length;
  const unfinished = shown.filter((c) => c.status === "ok" && !c.complete).length;
  failuresTable.show(failed);
  body.replaceChildren(
    failed.length ? failuresTable.node
      : element("p", { class: "empty" }, shown.length ? "Every case shown has correct answers and a time." : "No case matches the filters."),
    ...(unchecked ? [element("p", { class: "notice" }, `The answers of ${plural(unchecked, "case")} were not checked.`)] : []),
    ...(unfinished ? [element("p", { class: "notice" }, `${plural(unfinished, "case")} ran fewer repetitions than requested because the run was interrupted.`)] : []),
    ...gapLists());
}

// Variants without a case on recordings of a file that has the variant on other recordings.
function gapLists() {
  return machinesShown().flatMap((machine) => {
    const { rows, recordings: ranked } = rank(shown, machine);
    const gaps = rows.map((row) => ({ row, missing: row.cells.filter((cell) => !cell.testCase && cell.asked) }))
      .filter((gap) => gap.missing.length);
    if (!gaps.length) return [];
    const where = machines.length > 1 ? ` on ${machines[machine].name}` : "";
    return [element("details", { class: "more", open: view.printing },
      element("summary", {}, `Not run${where}: ${plural(gaps.length, "variant")} on some of ${plural(ranked.length, "recording")}`),
      element("ul", { class: "plain" }, gaps.map(({ row, missing }) => element("li", {}, element("b", {}, row.variant),
        missing.length > 6 ? `: on ${missing.length} of ${ranked.length} recordings`
          : `: ${missing.map((cell) => cell.recording.title).join("; ")}`))))];
  });
}
