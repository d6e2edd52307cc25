// A table that is sorted by its headers and shown page by page.

const kRows = 50;
const kPrintedRows = 200;

// columns: {title, value(row): what it is sorted by, show(row), number, rank: 1 always shown … 3 only
// on wide screens, name: a class of its cells}. The first column's button opens the row.
function makeTable(name, columns, start) {
  const state = { column: start, descending: false, page: 0, rows: [] };
  const head = element("tr");
  const body = element("tbody");
  const pager = element("div", { class: "row pager" });
  const table = element("table", { class: "cases", "aria-label": name }, element("thead", {}, head), body);
  const draw = () => {
    const column = columns[state.column];
    const sign = state.descending ? -1 : 1;
    const known = (value) => value !== null && value !== undefined && value !== "";
    const keyed = state.rows.map((row) => [column.value(row), row]);
    keyed.sort(([a], [b]) => (!known(a) || !known(b) ? known(b) - known(a) : sign * (a < b ? -1 : a > b ? 1 : 0)));
    const size = view.printing ? kPrintedRows : kRows;
    const pages = Math.max(1, Math.ceil(keyed.length / size));
    state.page = Math.min(state.page, pages - 1);
    const first = state.page * size;
    const part = keyed.slice(first, first + size).map(([, row]) => row);
    body.replaceChildren(...part.map((row) => rowOf(columns, row)));
    head.replaceChildren(...columns.map((one, i) => header(one, i)));
    const turn = (by, title, mark) => button(mark, () => { state.page += by; draw(); pager.querySelector(`[aria-label="${title}"]`).focus(); },
      { "aria-label": title, disabled: by < 0 ? state.page === 0 : state.page === pages - 1 });
    pager.replaceChildren(
      element("span", { class: "muted" }, keyed.length
        ? `${count(first + 1)} to ${count(first + part.length)} of ${count(keyed.length)}` : "nothing"),
      ...(pages > 1 && !view.printing ? [turn(-1, "Previous page", "‹"), turn(1, "Next page", "›")] : []));
  };
  // On paper without buttons: Chromium repeats only such heads on every page.
  const header = (column, i) => {
    const sorted = i === state.column;
    const mark = sorted ? (state.descending ? " ▾" : " ▴") : "";
    return element("th", { scope: "col", class: classOf(column),
                           "aria-sort": sorted ? (state.descending ? "descending" : "ascending") : false },
      view.printing ? column.title + mark : button(column.title + mark, () => {
        state.descending = sorted && !state.descending;
        state.column = i;
        state.page = 0;
        draw();
        head.children[i].querySelector("button").focus();
      }));
  };
  return {
    node: element("div", {}, element("div", { class: "scroll" }, table), pager),
    show(rows) { state.rows = rows; draw(); },
  };
}

const classOf = (column) => `rank${column.rank} ${column.number ? "number" : column.name || ""}`;

function rowOf(columns, row) {
  return element("tr", { click: (event) => { if (!event.target.closest("button")) showDetails([row]); } },
    columns.map((column, i) => {
      const text = column.show(row);
      return element("td", { class: classOf(column), title: column.name ? text : false },
                     i === 0 ? button(text, () => showDetails([row]), { class: "link" }) : text);
    }));
}

const kMachineColumns = machines.length > 1 ? [{
  title: "machine", name: "machine", value: (one) => machines[one.machine].name,
  show: (one) => machines[one.machine].name, rank: 2, place: 60,
}] : [];

// From the left by their places.
const kCaseColumns = [
  { title: "variant", value: nameOf, show: nameOf, rank: 1, place: 10 },
  { title: "recording", value: (one) => one.on.series, show: (one) => one.on.series, rank: 1, place: 20 },
  ...kMachineColumns,
  { title: "± 95 %", value: halfWidth, show: (one) => (halfWidth(one) === null ? kNothing : percent(halfWidth(one))), number: true, rank: 2, place: 95 },
  ...kFields.filter((field) => field.report > 0).map((field) => ({
    title: field.heading, value: (one) => valueOf(field, one),
    show: field.key === "status" ? (one) => statusMark(statusOf(one)) : (one) => textOfField(field, one),
    number: field.kind === "number", rank: field.rank, place: field.report,
  })),
].sort((a, b) => a.place - b.place);

// Half the interval's width as a share of the mean.
function halfWidth(one) {
  if (one.ci95_low_seconds === null || !one.seconds_per_frame) return null;
  return (one.ci95_high_seconds - one.ci95_low_seconds) / 2 / one.seconds_per_frame;
}

const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)}\u00a0%`;

let casesTable = null;

function drawCases(body) {
  if (!casesTable) {
    casesTable = makeTable("All cases", kCaseColumns, kCaseColumns.findIndex((one) => one.title === "mean"));
    body.replaceChildren(casesTable.node);
  }
  casesTable.show(shown);
}
