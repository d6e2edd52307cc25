// The data: a case is an object with the columns of a row.

const data = JSON.parse(byId("data").textContent);
const { machines, recordings } = data;
const cases = readCases();

function readCases() {
  const { columns } = data;
  const made = columns.machine.map((_, i) => ({ index: i }));
  for (const [name, column] of Object.entries(columns)) {
    if (Array.isArray(column)) made.forEach((one, i) => { one[name] = column[i]; });
    else made.forEach((one, i) => { one[name] = column.texts[column.codes[i]]; });
  }
  for (const one of made) {
    one.on = recordings[one.recording];
    one.wrong_frames = ownOf(data.wrong_frames, one.index) || [];
  }
  return made;
}

recordings.forEach((one, i) => {
  one.index = i;
  one.series = [one.scene, one.object_type].join(" ") + (one.setting ? `, ${one.setting}` : "");
  one.title = `${one.series}, ${plural(one.objects, "body", "bodies")}`;
});

// What the program's results have of a case, as its own table of columns says.
const kFields = data.fields;
const valueOf = (field, one) => (field.key in one ? one[field.key] : one.on[field.key]);

function textOfField(field, one) {
  if (field.known === "checked" && !one.checked) return "not checked";
  const value = valueOf(field, one);
  if (field.kind === "text") return value || kNothing;
  return field.unit === "seconds" ? time(value) : field.unit === "bytes" ? bytes(value) : count(value);
}

// The times that cases can be compared by.
const kMeasures = ["seconds_per_frame", "median_seconds", "p95_seconds", "p99_seconds"]
  .map((key) => [key, kFields.find((field) => field.key === key).title]);

const isSelfCheck = (one) => one.family === "self-check";

// A wrong answer has no time to compare.
const isTimed = (one) => one.status === "ok" && one[view.measure] > 0;

// What a case is called where its recording is known, and where not.
const nameOf = (one) => one.variant;
const fullName = (one) => `${one.variant} on ${one.on.title}`;

function statusOf(one) {
  if (one.status !== "ok" || one.complete) return one.status;
  return `ok, ${one.repetitions} of ${one.repetitions_asked} repetitions`;
}

const kPhases = [["update_objects", "update objects"], ["clean_cache", "clean cache"],
                 ["update_structures", "update structures"], ["search_overlaps", "search overlaps"]];

// Times in nanoseconds per phase and point, and pairs; null if a case has none.
let timelineLines = null;

function timelineOf(one) {
  timelineLines = timelineLines || byId("timelines").textContent.split("\n");
  const line = timelineLines[one.index];
  if (!line) return null;
  const raw = Uint8Array.from(atob(line), (letter) => letter.charCodeAt(0));
  const values = new Float32Array(raw.buffer);
  const points = values.length / (kPhases.length + 1);
  const row = (i) => values.subarray(i * points, (i + 1) * points);
  return { points, phases: kPhases.map((_, i) => row(i)), pairs: row(kPhases.length) };
}

// What the page shows now.
const view = { measure: "seconds_per_frame", everyVariant: false, chosen: null, printing: false };
