// Worst frames, and times at the end of a recording beside those at its start.

const headingOf = (key) => kFields.find((field) => field.key === key).heading;
const columnsOf = (titles) => kCaseColumns.filter((column) => titles.includes(column.title));

const kWorstColumns = [
  ...columnsOf(["variant", "recording", "machine", headingOf("objects"), headingOf("seconds_per_frame")]),
  { title: "worst frame", value: (c) => c.worst_seconds, show: (c) => time(c.worst_seconds), number: true, rank: 1 },
  { title: "worst frame / mean", value: (c) => worstOfMean(c), show: (c) => factor(worstOfMean(c)), number: true, rank: 2 },
  { title: "at frame", value: (c) => c.worst_frame, show: (c) => count(c.worst_frame), number: true, rank: 3 },
  { title: "p99.9", value: (c) => c.p999_seconds, show: (c) => time(c.p999_seconds), number: true, rank: 3 },
  { title: "late / early", value: (c) => c.late_over_early, show: (c) => factor(c.late_over_early), number: true, rank: 1 },
  { title: "tests, late / early", value: (c) => c.tests_late_over_early, show: (c) => factor(c.tests_late_over_early), number: true, rank: 3 },
  ...columnsOf([headingOf("peak_bytes")]),
  { title: "memory, late / early", value: (c) => c.memory_late_over_early, show: (c) => factor(c.memory_late_over_early), number: true, rank: 2 },
];

let worstTable = null;

function drawWorst(body) {
  if (!worstTable) {
    worstTable = makeTable("Worst frames", kWorstColumns, kWorstColumns.findIndex((column) => column.title === "worst frame"));
    body.replaceChildren(worstTable.node);
  }
  worstTable.show(shown.filter((c) => !c.superseded && !isSelfCheck(c) && isTimed(c)));
}

const worstOfMean = (c) => (c.worst_seconds === null ? null : c.worst_seconds / c.seconds_per_frame);
const factor = (value) => (value === null ? kNoValue : ratio(value));
