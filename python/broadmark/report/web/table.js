// A table with sortable columns and pages.

const kRowsPerPage = 50;

// columns: {title, value(row): the sort key, show(row), number, rank: from 1 (always shown) to 3 (only
// on wide screens), name: a class of the cells}. The buttons of the first column open the details.
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
    const sortedRows = state.rows.map((row) => [column.value(row), row]);
    // Self-checks and unknown values come last.
    sortedRows.sort(([a, rowA], [b, rowB]) => isSelfCheck(rowA) - isSelfCheck(rowB)
      || (!known(a) || !known(b) ? known(b) - known(a) : sign * (a < b ? -1 : a > b ? 1 : 0)));
    const size = view.printing ? Infinity : kRowsPerPage;
    const pages = Math.max(1, Math.ceil(sortedRows.length / size));
    if (!view.printing) state.page = Math.min(state.page, pages - 1);
    const first = view.printing ? 0 : state.page * size;
    const pageRows = sortedRows.slice(first, first + size).map(([, row]) => row);
    body.replaceChildren(...pageRows.map((row) => rowOf(columns, row)));
    head.replaceChildren(...columns.map((other, i) => header(other, i)));
    const pageButton = (by, title, mark) => button(mark, () => { state.page += by; draw(); pager.querySelector(`[aria-label="${title}"]`).focus(); },
      { "aria-label": title, disabled: by < 0 ? state.page === 0 : state.page === pages - 1 });
    pager.replaceChildren(
      element("span", { class: "muted" }, sortedRows.length
        ? `${count(first + 1)} to ${count(first + pageRows.length)} of ${count(sortedRows.length)}` : "no cases"),
      ...(pages > 1 && !view.printing ? [pageButton(-1, "Previous page", "‹"), pageButton(1, "Next page", "›")] : []));
  };
  // No buttons in print: Chromium repeats only table heads without them on every page.
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
    node: element("div", {}, scrollable(table), pager),
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
  title: "machine", name: "machine", value: (c) => machines[c.machine].name,
  show: (c) => machines[c.machine].name, rank: 2, place: 60,
}] : [];

// Ordered by `place`.
const kCaseColumns = [
  { title: "variant", value: nameOf, show: nameOf, rank: 1, place: 10 },
  { title: "recording", value: (c) => c.recording.series, show: (c) => c.recording.series, rank: 1, place: 20 },
  ...kMachineColumns,
  { title: "± 95 %", value: halfWidth, show: (c) => (halfWidth(c) === null ? kNoValue : percent(halfWidth(c))), number: true, rank: 2, place: 95 },
  ...kFields.filter((field) => field.report > 0).map((field) => ({
    title: field.heading, value: (c) => valueOf(field, c),
    show: field.key === "status" ? (c) => statusMark(statusOf(c)) : (c) => textOfField(field, c),
    number: field.kind === "number", rank: field.rank, place: field.report,
  })),
].sort((a, b) => a.place - b.place);

// Half the width of the confidence interval, relative to the mean.
function halfWidth(testCase) {
  if (testCase.ci95_low_seconds === null || !testCase.seconds_per_frame) return null;
  return (testCase.ci95_high_seconds - testCase.ci95_low_seconds) / 2 / testCase.seconds_per_frame;
}

const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)}\u00a0%`;

let casesTable = null;

function drawCases(body) {
  if (!casesTable) {
    casesTable = makeTable("All cases", kCaseColumns, kCaseColumns.findIndex((column) => column.title === "mean"));
    body.replaceChildren(casesTable.node);
  }
  casesTable.show(shown);
}
