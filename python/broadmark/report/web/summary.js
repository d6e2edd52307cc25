// The summary: runs, machines and warnings.

function drawSummary() {
  const versions = distinct(machines.map((machine) => factOf(machine, "Program version")).filter(Boolean));
  const computers = distinct(machines.map((machine) => machine.computer)).length;
  const started = data.runs.map((run) => run.started).filter(Boolean).sort();
  byId("title").textContent = data.title;
  byId("subtitle").textContent = [
    started.length ? dates(started) : "", versions.length ? `Broadmark ${versions.join(", ")}` : "",
    `page written ${data.written} UTC`].filter(Boolean).join(" · ");
  byId("summary").append(
    element("div", { class: "tiles" },
      tile(cases.length, "case"), tile(recordings.length, "recording"),
      tile(distinct(cases.filter((c) => !isSelfCheck(c)).map((c) => c.algorithm)).length, "algorithm"), tile(computers, "machine"),
      machines.length > computers ? tile(machines.length, "build") : null,
      element("div", { class: "tile statuses" }, statusCounts())),
    ...warnings().map((text) => element("p", { class: "notice" }, text)),
    ...gallery(),
    element("details", { class: "more" }, element("summary", {}, "Machines, builds and files"),
      element("div", { class: "machines" }, machines.map((machine) => element("div", { class: "machine" },
        element("h3", {}, machine.name), facts("particulars", machine.facts)))),
      element("h3", {}, "Files"),
      element("ul", { class: "plain" }, data.runs.map((run) => element("li", {}, element("b", {}, run.file),
        run.complete ? "" : " (partial)", run.started ? ` started ${run.started}` : "",
        element("code", {}, run.command))))));
  byId("about").append(
    element("p", {}, "Times and intervals are taken from the results files. Ratios compare only cases of the same machine."),
    element("details", {}, element("summary", {}, "Charts are drawn by d3"), element("pre", {}, data.licence)));
}

const factOf = (machine, title) => (machine.facts.find(([name]) => name === title) || [])[1];

function dates(started) {
  const days = distinct(started.map((text) => text.slice(0, 10)));
  return days.length === 1 ? `run ${days[0]}` : `run ${days[0]} to ${days[days.length - 1]}`;
}

function tile(number, word) {
  return element("div", { class: "tile" }, element("b", {}, count(number)), " ", number === 1 ? word : `${word}s`);
}

// A button per status that filters the cases by it.
function statusCounts() {
  const statuses = d3.nest().key((c) => c.status).rollup((group) => group.length).entries(cases);
  return statuses.map(({ key, value }) => button("", () => filterBy("status", [key]), { class: "plain-button", title: `Show only ${key}` }))
    .map((node, i) => {
      node.append(element("b", {}, count(statuses[i].value)), " ", statusMark(statuses[i].key));
      return node;
    });
}

function warnings() {
  const texts = [];
  for (const run of data.runs) {
    if (!run.complete) texts.push(`${run.file} is partial because the run was not finished. Its finished cases are shown.`);
  }
  for (const machine of machines) {
    const build = factOf(machine, "Build type");
    if (build && !/^Rel/.test(build)) texts.push(`${machine.name}: a ${build} build; its times are not representative.`);
  }
  const counts = new Map();
  for (const testCase of cases) {
    for (const text of testCase.warnings.split("; ").filter(Boolean)) counts.set(text, (counts.get(text) || 0) + 1);
  }
  const sorted = [...counts].sort((a, b) => b[1] - a[1]);
  texts.push(...sorted.slice(0, 6).map(([text, number]) => `Warning: ${text} (${plural(number, "case")}).`));
  if (sorted.length > 6) texts.push(`${plural(sorted.length - 6, "more kind of warning", "more kinds of warnings")}; see the details of each case.`);
  const superseded = cases.filter((c) => c.superseded).length;
  if (superseded) texts.push(`${plural(superseded, "case was", "cases were")} run again later; charts show only the last run, the table shows all runs.`);
  return texts;
}

function gallery() {
  const pictures = data.pictures.map((picture) => {
    const recording = recordings[picture.recording];
    const image = element("img", { alt: `${recording.title}, frame ${picture.frame}`, width: 480, height: 360, loading: "lazy" });
    image.src = picture.uri;
    return element("figure", {}, image, element("figcaption", {}, element("b", {}, recording.series), ` ${plural(recording.objects, "body", "bodies")}, frame ${picture.frame}`));
  });
  const notes = data.picture_notes.map((note) => element("p", { class: "muted note" }, note));
  return pictures.length ? [element("div", { class: "gallery" }, pictures), ...notes] : notes;
}
