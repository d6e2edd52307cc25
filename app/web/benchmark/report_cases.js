// Adds the cases of results (docs/results.md) to a report page of the same cases on other machines.

const kReportPhases = ["update_objects", "clean_cache", "update_structures", "search_overlaps"];
const kFacts = [["Processor", "cpu"], ["Cores", "logical_cores"], ["Widest instruction set", "isa"], ["System", "os"],
                ["Compiler", "compiler"], ["Program version", "version"], ["Commit", "commit"]];

const mean = (numbers) => numbers.reduce((sum, each) => sum + each, 0) / numbers.length;

// The value of a column, by the form that the table of columns states for it.
function valueOfColumn({ path, form, if_missing: ifMissing }, testCase) {
  const value = path.split("/").reduce((part, name) => part?.[name], testCase) ?? ifMissing;
  if (form === "count") return value.length;
  if (form === "seconds") return value?.flat().length ? mean(value.flat()) / 1e9 : null;
  if (form === "joined") return Object.entries(value).map(([name, text]) => `${name}=${text}`).join(";");
  return form === "value" ? value : null;
}

// A line of times by frame, each the mean over the repetitions, and pairs.
function timelineOf(testCase) {
  const { frames, frame_counts: counts } = testCase;
  if (!frames.total.length) return "";
  const points = Math.min(...frames.total.map((times) => times.length));
  const rows = kReportPhases.map((phase) => (
    Array.from({ length: points }, (_, i) => mean(frames[phase].map((times) => times[i])))));
  const bytes = new Uint8Array(new Float32Array([...rows, counts.pairs.slice(0, points)].flat()).buffer);
  return btoa(String.fromCharCode(...bytes));
}

// The text of the page with the results' cases. A case takes what they do not state, such as its
// label, from the page's case of the same algorithm on the same scene.
function withCases(html, results) {
  const page = new DOMParser().parseFromString(html, "text/html");
  const data = JSON.parse(page.getElementById("data").textContent);
  const timelines = page.getElementById("timelines").textContent.split("\n");
  const { columns, recordings } = data;
  const at = (column, i) => (Array.isArray(column) ? column[i] : column.texts[column.codes[i]]);
  const known = columns.machine.map((_, i) => i);
  const fields = data.fields.filter(({ key, path }) => key in columns && !path.startsWith("recording/"));

  const differing = new Set();
  for (const testCase of results.cases) {
    const { name, objects, hash } = testCase.recording;
    const like = known.find((i) => {
      const recording = recordings[columns.recording[i]];
      return at(columns.algorithm, i) === testCase.algorithm && recording.scene === name && recording.objects === objects;
    });
    if (recordings[columns.recording[like]].hash !== hash) differing.add(name);
    const row = Object.fromEntries(Object.entries(columns).map(([key, column]) => [key, at(column, like)]));
    for (const field of fields) row[field.key] = valueOfColumn(field, testCase);
    const times = testCase.frames.total[0] || [];
    const means = testCase.frames.total.map(mean);
    Object.assign(row, {
      machine: data.machines.length, isa: testCase.vectorised ? testCase.isa : "", checked: Number(testCase.checked),
      complete: 1, warnings: testCase.conditions.warnings.join("; "), file: "this browser", load: null,
      standard_error: means.length === 2 ? Math.abs(means[0] - means[1]) / 2 / mean(means) : null,
      worst_seconds: times.length ? Math.max(...times) / 1e9 : null, frames_run: times.length,
      worst_frame: times.length ? times.indexOf(Math.max(...times)) + 1 : null, late_over_early: null,
      counted: "", again_command: "browser.json",
    });
    for (const [key, value] of Object.entries(row)) {
      const column = columns[key];
      if (Array.isArray(column)) {
        column.push(value ?? null);
        continue;
      }
      const text = String(value ?? "");
      if (!column.texts.includes(text)) column.texts.push(text);
      column.codes.push(column.texts.indexOf(text));
    }
    timelines.push(timelineOf(testCase));
  }
  const [environment] = results.environments;
  const facts = kFacts.map(([title, key]) => [title, String(environment[key] ?? "")]).filter(([, text]) => text);
  data.machines.push({ name: environment.host, facts });
  data.runs.push({ file: "this browser", command: `broadmark ${results.options.join(" ")}`, started: environment.started,
                   complete: results.complete });
  if (differing.size) {
    data.picture_notes.push(`${[...differing].join(", ")}: physics computed by another processor differs in the last `
      + "digits, so the boxes here are alike but not the same.");
  }
  data.title = "Broad phases, in this browser and natively";
  page.getElementById("data").textContent = JSON.stringify(data).replaceAll("<", "\\u003c").replaceAll(">", "\\u003e");
  page.getElementById("timelines").textContent = timelines.join("\n");
  return `<!DOCTYPE html>${page.documentElement.outerHTML}`;
}
