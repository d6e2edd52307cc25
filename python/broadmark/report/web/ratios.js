// Ratios to the best: a table per machine with a row per variant and a column per recording.

const kRatioLimits = [1.0005, 1.25, 2, 4, 8, 16, 64, Infinity];
const kMaxColumns = 20;  // per page
const kMaxRows = 60;
const kPrintedColumns = 12;

let firstColumn = 0;
let allRows = false;

function drawRatios(body) {
  body.replaceChildren();
  const rankings = machinesShown().map((machine) => rank(shown, machine)).filter((ranking) => ranking.rows.length);
  if (!rankings.length) {
    body.append(element("p", { class: "empty" }, "No case that can be ranked matches the filters."));
    return;
  }
  body.append(element("p", { class: "scale", "aria-hidden": "true" }, "best ", kRatioLimits.map((limit, i) => (
    element("span", { class: `heat h${i}` }, i === 0 ? "1" : limit === Infinity ? "more" : `≤ ${Math.round(limit * 100) / 100}`)))));
  if (rankings.length > 1) body.append(sideBySide(rankings));
  for (const ranking of rankings) {
    const section = element("div", { class: "ranking" });
    if (machines.length > 1) section.append(element("h3", {}, machines[ranking.machine].name));
    const total = ranking.recordings.length;
    const begin = view.printing || firstColumn >= total ? 0 : firstColumn;
    const end = view.printing ? total : Math.min(begin + kMaxColumns, total);
    if (total > kMaxColumns && !view.printing) section.append(columnPager(body, begin, end, total));
    const step = view.printing ? kPrintedColumns : kMaxColumns;
    for (let first = begin; first < end; first += step) {
      section.append(ratioTable(ranking, first, Math.min(first + step, end)));
    }
    const hidden = allRows || view.printing ? 0 : ranking.rows.length - kMaxRows;
    if (hidden > 0) {
      section.append(button(`Show ${plural(hidden, "slower variant")}`, () => { allRows = true; drawRatios(body); }));
    }
    body.append(section);
  }
}

// Pages through the recordings. The means always include all recordings.
function columnPager(body, begin, end, total) {
  const pageButton = (target, title, mark) => button(mark, () => {
    firstColumn = target;
    drawRatios(body);
    const redrawn = body.querySelector(`[aria-label="${title}"]`);
    if (redrawn) redrawn.focus();
  }, { "aria-label": title, disabled: target < 0 || target >= total });
  return element("div", { class: "row pager" },
    element("span", { class: "muted" }, `Recordings ${begin + 1} to ${end} of ${total}`),
    pageButton(begin - kMaxColumns, "Previous recordings", "‹"), pageButton(begin + kMaxColumns, "Next recordings", "›"));
}

// The means of each machine side by side. Nothing is computed across machines.
function sideBySide(rankings) {
  const means = rankings.map((ranking) => new Map(ranking.rows.map((row) => [row.variant, row])));
  const variants = distinct(rankings.flatMap((ranking) => ranking.rows.map((row) => row.variant)));
  return element("div", { class: "ranking" }, element("h3", {}, "Machines side by side"),
    scrollable(element("table", { class: "heat-table side" },
      element("thead", {},
        element("tr", {}, element("td", {}),
          rankings.map((ranking) => element("th", { scope: "colgroup", colspan: 3 }, machines[ranking.machine].name))),
        element("tr", {}, element("th", { scope: "col" }, "variant"),
          rankings.map(() => ["mean", "rank", "gaps"].map((title) => element("th", { scope: "col" }, title))))),
      element("tbody", {}, variants.map((variant) => element("tr", {}, element("th", { scope: "row" }, variant),
        means.map((mean) => {
          const row = mean.get(variant);
          if (!row) return [element("td", { class: "heat gap" }, "not run"), element("td"), element("td")];
          return [meanCell(row), element("td", {}, row.mean === null ? kNoValue : `${row.rank}.`), gapCell(row)];
        }))))), { tabindex: 0, role: "region", "aria-label": "Machines side by side" }));
}

function meanCell(row) {
  if (row.mean === null) return element("td", { class: "heat gap" }, kNoValue);
  return element("td", { class: `heat mean ${heatClass(row.mean, row.tie)}` }, ratio(row.mean));
}

function gapCell(row) {
  return element("td", { class: "gaps", title: `${row.gaps} of ${row.recordingCount} recordings missing` }, row.gaps || "");
}

function heatClass(value, tie) {
  return tie ? "h0" : `h${Math.max(1, kRatioLimits.findIndex((limit) => value <= limit))}`;
}

function ratioTable({ machine, recordings: ranked, rows: ranking }, first, last) {
  const rows = allRows || view.printing ? ranking : ranking.slice(0, kMaxRows);
  const columns = ranked.slice(first, last);
  const groups = d3.nest().key((recording) => recording.series).entries(columns);
  const table = element("table", { class: "heat-table", role: "grid",
                                   "aria-label": `Ratios to the best, ${machines[machine].name}` },
    element("thead", {},
      element("tr", {}, element("td", {}), element("td", { colspan: 2 }),
              groups.map(({ key, values }) => element("th", { colspan: values.length, scope: "colgroup" }, key))),
      element("tr", {}, element("th", { scope: "col" }, "variant"), element("th", { scope: "col" }, "mean"),
              element("th", { scope: "col" }, "gaps"),
              columns.map((recording) => element("th", { scope: "col", title: recording.title }, d3.format("~s")(recording.objects))))),
    element("tbody", {}, rows.map((row) => element("tr", {},
      element("th", { scope: "row" }, row.variant), meanCell(row), gapCell(row),
      row.cells.slice(first, last).map(ratioCell)))));
  makeGrid(table, rows, first);
  return scrollable(table);
}

function ratioCell(cell) {
  if (cell.ratio === null) return element("td", { class: `heat ${cell.asked ? "gap" : "unasked"}`, role: "gridcell" }, absenceOf(cell));
  return element("td", { class: `heat ${heatClass(cell.ratio, cell.tie)}`, role: "gridcell" }, ratio(cell.ratio),
    cell.half === null || cell.ratio * cell.half < 0.005 ? null : element("small", {}, ` ±${ratio(cell.ratio * cell.half)}`));
}

function absenceOf({ testCase, asked }) {
  if (!testCase) return asked ? "not run" : "not requested";
  return testCase.status === "ok" ? "no time" : testCase.status;
}

function cellLines({ testCase, recording, ratio: value, half, tie, asked }, variant) {
  if (!testCase) return [variant, recording.title, asked ? "not run" : "not requested in the runs with this recording"];
  if (value === null) return caseLines(testCase);
  const interval = half === null ? "" : `, 95 %: ${ratio(value * Math.exp(-half))} to ${ratio(value * Math.exp(half))}`;
  return [...caseLines(testCase), `${ratio(value)} times the best${interval}${tie && value > 1 ? ": no slower within the noise" : ""}`];
}

// The table is a single tab stop; arrow keys move between cells.
function makeGrid(table, rows, first) {
  const cells = [...table.tBodies[0].rows].map((row) => [...row.querySelectorAll("[role=gridcell]")]);
  const cellAt = (node) => {
    const td = node.closest && node.closest("[role=gridcell]");
    if (!td) return null;
    const r = td.parentNode.sectionRowIndex;
    const c = td.cellIndex - 3;
    return { td, r, c, cell: rows[r].cells[first + c], variant: rows[r].variant };
  };
  if (cells.length && cells[0].length) cells[0][0].tabIndex = 0;
  const show = (event) => {
    const at = cellAt(event.target);
    if (!at) { hideTooltip(); return; }
    if (event.type === "focusin") showTooltipAt(at.td, cellLines(at.cell, at.variant));
    else showTooltip(at.td, cellLines(at.cell, at.variant), event.clientX, event.clientY);
  };
  table.addEventListener("pointermove", show);
  table.addEventListener("focusin", show);
  table.addEventListener("pointerleave", hideTooltip);
  table.addEventListener("focusout", hideTooltip);
  const open = (event) => {
    const at = cellAt(event.target);
    if (at && at.cell.testCase) showDetails([at.cell.testCase]);
  };
  table.addEventListener("click", open);
  table.addEventListener("keydown", (event) => {
    const at = cellAt(event.target);
    if (!at) return;
    const move = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    if (event.key === "Enter" || event.key === " ") open(event);
    else if (!move) return;
    else {
      const next = (cells[at.r + move[0]] || [])[at.c + move[1]];
      if (next) { at.td.tabIndex = -1; next.tabIndex = 0; next.focus(); }
    }
    event.preventDefault();
  });
}
