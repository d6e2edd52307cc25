// Filters: a set of allowed texts per column (none: all of them), and words to search for.

const kFilters = [
  { name: "scene", label: "Scene", of: (one) => one.on.scene },
  { name: "object_type", label: "Object type", of: (one) => one.on.object_type },
  { name: "objects", label: "Bodies", of: (one) => count(one.on.objects), order: (one) => one.on.objects },
  ...distinct(recordings.flatMap((one) => Object.keys(one.parameters))).sort().map((name) => (
    { name: `scene ${name}`, label: `Scene's ${name}`, of: (one) => ownOf(one.on.parameters, name) || "not set" })),
  { name: "algorithm", label: "Algorithm", of: (one) => one.algorithm, group: (one) => one.family },
  { name: "threads", label: "Threads", of: (one) => String(one.threads), order: (one) => one.threads },
  { name: "isa", label: "ISA", of: (one) => one.isa || "not vectorised" },
  ...Object.entries(data.parameters).map(([name, column]) => (
    { name: `param ${name}`, label: name, of: (one) => column.texts[column.codes[one.index]] || "not set" })),
  { name: "device", label: "Device", of: (one) => one.device || "none" },
  { name: "machine", label: "Machine", of: (one) => machines[one.machine].name },
  { name: "status", label: "Status", of: (one) => one.status },
  { name: "file", label: "File", of: (one) => one.file },
].map((filter) => ({ ...filter, allowed: null, options: optionsOf(filter) }))
  .filter((filter) => filter.options.length > 1);

let searched = "";
let shown = cases;
let waitingForPause = 0;

function optionsOf({ of, order, group }) {
  const options = new Map();
  for (const one of cases) {
    const text = of(one);
    const known = options.get(text);
    if (known) known.cases += 1;
    else options.set(text, { text, cases: 1, order: order ? order(one) : 0, group: group ? group(one) : "" });
  }
  const sorted = [...options.values()];
  if (group) return sorted;  // in the program's order
  return sorted.sort((a, b) => a.order - b.order || a.text.localeCompare(b.text, "en", { numeric: true }));
}

function textOf(one) {
  one.text = one.text || [one.id, one.on.title, one.variant, one.family, one.isa, one.status, one.reason,
                          one.params, one.file, one.on.hash, machines[one.machine].name].join(" ").toLowerCase();
  return one.text;
}

function applyFilters() {
  const active = kFilters.filter((filter) => filter.allowed);
  const files = active.find((filter) => filter.name === "file");
  takeLastRuns(files ? cases.filter((one) => files.allowed.has(one.file)) : cases);
  const words = searched.toLowerCase().split(/\s+/).filter(Boolean);
  shown = cases.filter((one) => active.every((filter) => filter.allowed.has(filter.of(one)))
    && words.every((word) => textOf(one).includes(word)));
  showFilters();
  refresh();
}

function clearFilters() {
  for (const filter of kFilters) filter.allowed = null;
  searched = "";
  byId("search").value = "";
  applyFilters();
}

// Only these texts of a filter; called by other parts of the page, too.
function filterBy(name, texts) {
  const filter = kFilters.find((one) => one.name === name);
  if (filter) filter.allowed = texts && new Set(texts);
  applyFilters();
}

function makeFilters() {
  const search = element("input", {
    id: "search", type: "search", placeholder: "Search cases", "aria-label": "Search cases",
    input: () => {
      clearTimeout(waitingForPause);
      waitingForPause = setTimeout(() => { searched = search.value; applyFilters(); }, 80);
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
    const box = element("input", { type: "checkbox", checked: true, change: () => takeBoxes(filter) });
    option.box = box;
    return [option.group, element("label", {}, box, element("span", {}, option.text),
                                  element("span", { class: "muted" }, count(option.cases)))];
  });
  const groups = distinct(boxes.map(([group]) => group)).map((group) => {
    const own = boxes.filter(([name]) => name === group).map(([, label]) => label);
    if (!group) return own;
    return element("fieldset", {}, element("legend", {}, button(group, () => {
      filter.allowed = new Set(filter.options.filter((option) => option.group === group).map((one) => one.text));
      applyFilters();
    }, { class: "link", title: `only ${group}` })), own);
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

function takeBoxes(filter) {
  const checked = filter.options.filter((option) => option.box.checked);
  filter.allowed = checked.length === filter.options.length ? null : new Set(checked.map((one) => one.text));
  applyFilters();
}

function showFilters() {
  const told = searched ? [`“${searched}”`] : [];
  for (const filter of kFilters) {
    for (const option of filter.options) {
      option.box.checked = !filter.allowed || filter.allowed.has(option.text);
    }
    const allowed = filter.allowed;
    const what = !allowed ? "all" : allowed.size === 1 ? [...allowed][0] : `${allowed.size} of ${filter.options.length}`;
    if (allowed) told.push(`${filter.label}: ${[...allowed].join(", ") || "none"}`);
    filter.summary.replaceChildren(element("span", { class: "muted" }, filter.label), " ",
                                   element("span", { class: "chosen" }, what));
    filter.element.classList.toggle("active", allowed !== null);
  }
  byId("clear").hidden = !told.length;
  byId("found").textContent = told.length
    ? `${count(shown.length)} of ${plural(cases.length, "case")}` : plural(cases.length, "case");
  byId("filtered").textContent = told.length ? `Filtered: ${byId("found").textContent}. ${told.join("; ")}` : "";
}
