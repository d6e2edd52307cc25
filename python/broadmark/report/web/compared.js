// Two files: each case before and after, with the verdicts of `broadmark compare`.

const kVerdictOrder = ["REGRESSED", "slower", "other status", "not ok", "missing", "undecided", "faster"];
const { comparison } = data;
byId("compared").hidden = !comparison;  // what is hidden never comes near the viewport
if (comparison) for (const row of comparison.rows) cases[row.case].compared = row;

const kComparedColumns = [
  { title: "variant", value: nameOf, show: nameOf, rank: 1 },
  { title: "recording", value: (c) => c.recording.title, show: (c) => c.recording.title, rank: 1 },
  { title: "before", value: (c) => c.compared.seconds_before, show: (c) => time(c.compared.seconds_before), number: true, rank: 2 },
  { title: "after", value: (c) => c.compared.seconds_after, show: (c) => time(c.compared.seconds_after), number: true, rank: 2 },
  { title: "ratio", value: (c) => c.compared.ratio, show: (c) => (c.compared.ratio === null ? kNoValue : c.compared.ratio.toFixed(3)), number: true, rank: 1 },
  { title: "95 %", value: (c) => c.compared.low, show: ({ compared: { low, high } }) => (low === null ? kNoValue : `${low.toFixed(3)} to ${high.toFixed(3)}`), number: true, rank: 2 },
  { title: "verdict", value: verdictOrder, show: verdictMark, rank: 1 },
];

// Regressions first; of one verdict the largest ratio.
function verdictOrder({ compared: { verdict, ratio: value } }) {
  const place = kVerdictOrder.indexOf(verdict);
  return 1e6 * (place < 0 ? kVerdictOrder.length : place) - (value || 0);
}

function verdictMark({ compared: { verdict, reason } }) {
  const kind = { REGRESSED: "mismatch", slower: "mismatch", faster: "ok" }[verdict] || "unsupported";
  return element("span", { class: `status ${kind}`, title: reason || false }, verdict);
}

let comparedTable = null;

function drawCompared(body) {
  if (!comparison) return;
  comparedTable = comparedTable || makeTable("Before and after", kComparedColumns, kComparedColumns.length - 1);
  comparedTable.show(shown.filter((c) => c.compared));
  body.replaceChildren(
    element("p", {}, element("b", {}, "before "), comparison.before, ", ", element("b", {}, "after "), comparison.after, `: ${comparison.summary}`),
    ...comparison.notes.map((text) => element("p", { class: "muted note" }, text)),
    comparedTable.node);
}
