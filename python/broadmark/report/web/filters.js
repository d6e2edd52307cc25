// Filters: a set of allowed texts per column (null: no restriction), and search words.

const kFilters = [
  { name: "scene", label: "Scene", of: (c) => c.recording.scene },
  { name: "object_type", label: "Object type", of: (c) => c.recording.object_type },
  { name: "objects", label: "Bodies", of: (c) => count(c.recording.objects), order: (c) => c.recording.objects },
  ...distinct(recordings.flatMap((recording) => Object.keys(recording.parameters))).sort().map((name) => (
    { name: `scene ${name}`, label: `Scene's ${name}`, of: (c) => ownProperty(c.recording.parameters, name) || "not set" })),
  { name: "algorithm", label: "Algorithm", of: (c) => c.algorithm, group: (c) => c.family },
  { name: "threads", label: "Threads", of: (c) => String(c.threads), order: (c) => c.threads },
  { name: "isa", label: "ISA", of: (c) => c.isa || "not vectorised" },
  ...Object.entries(data.parameters).map(([name, column]) => (
    { name: `param ${name}`, label: name, of: (c) => column.texts[column.codes[c.index]] || "not set" })),
  { name: "device", label: "Device", of: (c) => c.device || "none" },
  { name: "machine", label: "Machine", of: (c) => machines[c.machine].name },
  { name: "status", label: "Status", of: (c) => c.status },
  { name: "file", label: "File", of: (c) => c.file },
].map((filter) => ({ ...filter, allowed: null, options: optionsOf(filter) }))
  .filter((filter) => filter.options.length > 1);

let searchText = "";
let shown = cases;
let searchTimer = 0;

function optionsOf({ of, order, group }) {
  const options = new Map();
  for (const testCase of cases) {
    const text = of(testCase);
    const known = options.get(text);
    if (known) known.cases += 1;
    else options.set(text, { text, cases: 1, order: order ? order(testCase) : 0, group: group ? group(testCase) : "" });
  }
  const sorted = [...options.values()];
  if (group) return sorted;  // keep the program's order
  return sorted.sort((a, b) => a.order - b.order || a.text.localeCompare(b.text, "en", { numeric: true }));
}

function textOf(testCase) {
  testCase.text = testCase.text || [testCase.id, testCase.recording.title, testCase.variant, testCase.family, testCase.isa,
    testCase.status, testCase.reason, testCase.params, testCase.file, testCase.recording.hash, machines[testCase.machine].name].join(" ").toLowerCase();
  return testCase.text;
}

function applyFilters() {
  const active = kFilters.filter((filter) => filter.allowed);
  const files = active.find((filter) => filter.name === "file");
  markLastRuns(files ? cases.filter((c) => files.allowed.has(c.file)) : cases);
  const words = searchText.toLowerCase().split(/\s+/).filter(Boolean);
  shown = cases.filter((c) => active.every((filter) => filter.allowed.has(filter.of(c)))
    && words.every((word) => textOf(c).includes(word)));
  showFilters();
  refresh();
}

function clearFilters() {
  for (const filter of kFilters) filter.allowed = null;
  searchText = "";
  byId("search").value = "";
  applyFilters();
}

// Restricts a filter to some texts. Also called by other parts of the page.
function filterBy(name, texts) {
  const filter = kFilters.find((other) => other.name === name);
  if (filter) filter.allowed = texts && new Set(texts);
  applyFilters();
}

function makeFilters() {
  const search = element("input", {
    id: "search", type: "search", placeholder: "Search cases", "aria-label": "Search cases",
    input: () => {
      clearTimeout(searchTimer);
      searchTimer = setTimeout(() => { searchText = search.value; applyFilters(); }, 80);
    },
  });
  const measure = choice("Time", kMeasures.map(([, name]) => name), 0,
                         (i) => { view.measure = kMeasures[i][0]; refresh(); });
  byId("filters").append(
    element("div", { class: "found" }, search, measure, element("output", { id: "found" }),
            button("Clear filters", clearFilters, { id: "clear", hidden: true })),
    element("details", { class: "all-filters", open: window.innerWidth > 640 },
            element("summary", {}, "Filters"),
            element("div", { class: "filter-list" }, kFilters.map(makeFilter))));
  document.addEventListener("click", (event) => closeFilters(event.target));
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    const open = document.querySelector("details.filter[open]");
    if (!open) return;
    open.open = false;
    open.querySelector("summary").focus();
  });
}

function closeFilters(except) {
  for (const open of document.querySelectorAll("details.filter[open]")) {
    if (!open.contains(except)) open.open = false;
  }
}

function makeFilter(filter) {
  const boxes = filter.options.map((option) => {
    const box = element("input", { type: "checkbox", checked: true, change: () => applyBoxes(filter) });
    option.box = box;
    return [option.group, element("label", {}, box, element("span", {}, option.text),
                                  element("span", { class: "muted" }, count(option.cases)))];
  });
  const groups = distinct(boxes.map(([group]) => group)).map((group) => {
    const labels = boxes.filter(([name]) => name === group).map(([, label]) => label);
    if (!group) return labels;
    return element("fieldset", {}, element("legend", {}, button(group, () => {
      filter.allowed = new Set(filter.options.filter((option) => option.group === group).map((option) => option.text));
      applyFilters();
    }, { class: "link", title: `Select only ${group}` })), labels);
  });
  filter.summary = element("summary", {});
  filter.element = element(
    "details", { class: "filter", "data-filter": filter.name,
                 toggle: () => { if (filter.element.open) closeFilters(filter.element); } },
    filter.summary,
    element("div", { class: "panel" },
            element("div", { class: "row" },
                    button("all", () => { filter.allowed = null; applyFilters(); }, { class: "link" }),
                    button("none", () => { filter.allowed = new Set(); applyFilters(); }, { class: "link" })),
            groups));
  return filter.element;
}

function applyBoxes(filter) {
  const checked = filter.options.filter((option) => option.box.checked);
  filter.allowed = checked.length === filter.options.length ? null : new Set(checked.map((option) => option.text));
  applyFilters();
}

function showFilters() {
  const active = searchText ? [`“${searchText}”`] : [];
  for (const filter of kFilters) {
    for (const option of filter.options) {
      option.box.checked = !filter.allowed || filter.allowed.has(option.text);
    }
    const allowed = filter.allowed;
    const text = !allowed ? "all" : allowed.size === 1 ? [...allowed][0] : `${allowed.size} of ${filter.options.length}`;
    if (allowed) active.push(`${filter.label}: ${[...allowed].join(", ") || "none"}`);
    filter.summary.replaceChildren(element("span", { class: "muted" }, filter.label), " ",
                                   element("span", { class: "chosen" }, text));
    filter.element.classList.toggle("active", allowed !== null);
  }
  byId("clear").hidden = !active.length;
  byId("found").textContent = active.length
    ? `${count(shown.length)} of ${plural(cases.length, "case")}` : plural(cases.length, "case");
  byId("filtered").textContent = active.length ? `Filtered: ${byId("found").textContent}. ${active.join("; ")}` : "";
}
