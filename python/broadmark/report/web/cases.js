// The cases: objects with a property per column.

const data = JSON.parse(byId("data").textContent);
const { machines, recordings } = data;
const cases = readCases();

function readCases() {
  const { columns } = data;
  const result = columns.machine.map((_, i) => ({ index: i }));
  for (const [name, column] of Object.entries(columns)) {
    if (Array.isArray(column)) result.forEach((testCase, i) => { testCase[name] = column[i]; });
    else result.forEach((testCase, i) => { testCase[name] = column.texts[column.codes[i]]; });
  }
  for (const testCase of result) {
    testCase.recording = recordings[testCase.recording];
    testCase.wrong_frames = ownProperty(data.wrong_frames, testCase.index) || [];
  }
  return result;
}

recordings.forEach((recording, i) => {
  recording.index = i;
  recording.series = `${recording.scene} ${recording.object_type}`
    + (recording.setting ? `, ${recording.setting}` : "");
  recording.title = `${recording.series}, ${plural(recording.objects, "body", "bodies")}`;
});

// The columns of a case in the program's results.
const kFields = data.fields;
const valueOf = (field, testCase) => (field.key in testCase ? testCase : testCase.recording)[field.key];

function textOfField(field, testCase) {
  if (field.known === "checked" && !testCase.checked) return "not checked";
  const value = valueOf(field, testCase);
  if (field.kind === "text") return value || kNoValue;
  return field.unit === "seconds" ? time(value) : field.unit === "bytes" ? bytes(value) : count(value);
}

// The times that cases are compared by.
const kMeasures = ["seconds_per_frame", "median_seconds", "p95_seconds", "p99_seconds"]
  .map((key) => [key, kFields.find((field) => field.key === key).title]);

const isSelfCheck = (c) => c.family === "self-check";

// Cases with wrong answers are not compared.
const isTimed = (c) => c.status === "ok" && c[view.measure] > 0;

// The name of a case, without and with its recording.
const nameOf = (c) => c.variant;
const fullName = (c) => `${c.variant} on ${c.recording.title}`;

function statusOf(testCase) {
  if (testCase.status !== "ok" || testCase.complete) return testCase.status;
  return `ok, ${testCase.repetitions} of ${testCase.repetitions_asked} repetitions`;
}

const kPhases = [["update_objects", "update objects"], ["clean_cache", "clean cache"],
                 ["update_structures", "update structures"], ["search_overlaps", "search overlaps"]];

// Times in nanoseconds per phase and point, and pairs; null for a case without times.
let timelineLines = null;

function timelineOf(testCase) {
  timelineLines = timelineLines || byId("timelines").textContent.split("\n");
  const line = timelineLines[testCase.index];
  if (!line) return null;
  const raw = Uint8Array.from(atob(line), (character) => character.charCodeAt(0));
  const values = new Float32Array(raw.buffer);
  const points = values.length / (kPhases.length + 1);
  const row = (i) => values.subarray(i * points, (i + 1) * points);
  return { points, phases: kPhases.map((_, i) => row(i)), pairs: row(kPhases.length) };
}

// The state of the view.
const view = { measure: "seconds_per_frame", allVariants: false, chosen: null, printing: false };
