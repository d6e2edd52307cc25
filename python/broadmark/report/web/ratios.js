// Ratios to the best: a table per machine, variants by recordings.

const kSteps = [1.0005, 1.25, 2, 4, 8, 16, 64, Infinity];
const kMostColumns = 20;  // beside each other; the others are a button away
const kMostRows = 60;
const kPrintedColumns = 12;

let firstColumn = 0;
let everyRow = false;

function drawRatios(body) {
  body.replaceChildren();
  const rankings = machinesShown().map((machine) => rank(shown, machine)).filter((one) => one.rows.length);
  if (!rankings.length) {
    body.append(element("p", { class: "empty" }, "No case that can be ranked is left by the filters."));
    return;
  }
  body.append(element("p", { class: "scale", "aria-hidden": "true" }, "best ", kSteps.map((step, i) => (
    element("span", { class: `heat h${i}` }, i === 0 ? "1" : step === Infinity ? "more" : `≤ ${Math.round(step * 100) / 100}`)))));
  if (rankings.length > 1) body.append(sideBySide(rankings));
  for (const ranking of rankings) {
    const holder = element("div", { class: "ranking" });
    if (machines.length > 1) holder.append(element("h3", {}, machines[ranking.machine].name));
    const all = ranking.recordings.length;
    const begin = firstColumn < all ? firstColumn : 0;
    const end = Math.min(begin + kMostColumns, all);
    if (all > kMostColumns) holder.append(columnPager(body, begin, end, all));
    const step = view.printing ? kPrintedColumns : kMostColumns;
    for (let first = begin; first < end; first += step) {
      holder.append(ratioTable(ranking, first, Math.min(first + step, end)));
    }
    const hidden = everyRow ? 0 : ranking.rows.length - kMostRows;
    if (hidden > 0) {
      holder.append(button(`Show ${plural(hidden, "slower variant")}`, () => { everyRow = true; drawRatios(body); }));
    }
    body.append(holder);
  }
}

// Means are over all recordings, whichever are shown.
function columnPager(body, begin, end, all) {
  const turn = (to, title, mark) => button(mark, () => {
    firstColumn = to;
    drawRatios(body);
    const again = body.querySelector(`[aria-label="${title}"]`);
    if (again) again.focus();
  }, { "aria-label": title, disabled: to < 0 || to >= all });
  return element("div", { class: "row pager" },
    element("span", { class: "muted" }, `Recordings ${begin + 1} to ${end} of ${all}`),
    turn(begin - kMostColumns, "Previous recordings", "‹"), turn(begin + kMostColumns, "Next recordings", "›"));
}

// Each machine's own means beside each other: nothing is computed across machines.
function sideBySide(rankings) {
  const means = rankings.map((ranking) => new Map(ranking.rows.map((row, i) => [row.variant, { ...row, rank: i + 1 }])));
  const variants = distinct(rankings.flatMap((ranking) => ranking.rows.map((row) => row.variant)));
  return element("div", { class: "ranking" }, element("h3", {}, "Machines side by side"),
    element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": "Machines side by side" }, element("table", { class: "heat-table side" },
      element("thead", {},
        element("tr", {}, element("td", {}),
          rankings.map((ranking) => element("th", { scope: "colgroup", colspan: 3 }, machines[ranking.machine].name))),
        element("tr", {}, element("th", { scope: "col" }, "variant"),
          rankings.map(() => ["mean", "rank", "gaps"].map((title) => element("th", { scope: "col" }, title))))),
      element("tbody", {}, variants.map((variant) => element("tr", {}, element("th", { scope: "row" }, variant),
        means.map((mean) => {
          const row = mean.get(variant);
          if (!row) return [element("td", { class: "heat gap" }, "not run"), element("td"), element("td")];
          return [meanCell(row), element("td", {}, row.mean === null ? kNothing : `${row.rank}.`), gapCell(row)];
        })))))));
}

function meanCell(row) {
  if (row.mean === null) return element("td", { class: "heat gap" }, kNothing);
  return element("td", { class: `heat mean ${stepOf(row.mean)}` }, ratio(row.mean));
}

function gapCell(row) {
  return element("td", { class: "gaps", title: `${row.gaps} of ${row.of} recordings missing` }, row.gaps || "");
}

function stepOf(value) {
  return `h${kSteps.findIndex((step) => value <= step)}`;
}

function ratioTable({ machine, recordings: on, rows: all }, first, last) {
  const rows = everyRow ? all : all.slice(0, kMostRows);
  const part = on.slice(first, last);
  const groups = d3.nest().key((one) => one.series).entries(part);
  const table = element("table", { class: "heat-table", role: "grid",
                                   "aria-label": `Ratios to the best, ${machines[machine].name}` },
    element("thead", {},
      element("tr", {}, element("td", {}), element("td", { colspan: 2 }),
              groups.map(({ key, values }) => element("th", { colspan: values.length, scope: "colgroup" }, key))),
      element("tr", {}, element("th", { scope: "col" }, "variant"), element("th", { scope: "col" }, "mean"),
              element("th", { scope: "col" }, "gaps"),
              part.map((one) => element("th", { scope: "col", title: one.title }, d3.format("~s")(one.objects))))),
    element("tbody", {}, rows.map((row) => element("tr", {},
      element("th", { scope: "row" }, row.variant), meanCell(row), gapCell(row),
      row.cells.slice(first, last).map(ratioCell)))));
  makeGrid(table, rows, first);
  return element("div", { class: "scroll" }, table);
}

function ratioCell(cell) {
  if (cell.ratio === null) {
    return element("td", { class: "heat gap", role: "gridcell" },
                   !cell.one ? "not run" : cell.one.status === "ok" ? "no time" : cell.one.status);
  }
  return element("td", { class: `heat ${stepOf(cell.ratio)}`, role: "gridcell" }, ratio(cell.ratio));
}

function cellLines({ one, recording, ratio: value }, variant) {
  if (!one) return [variant, recording.title, "not run"];
  return [...caseLines(one), ...(value === null ? [] : [`${ratio(value)} times the best here`])];
}

// One stop of the Tab key; arrow keys go from cell to cell.
function makeGrid(table, rows, first) {
  const cells = [...table.tBodies[0].rows].map((row) => [...row.querySelectorAll("[role=gridcell]")]);
  const place = (node) => {
    const td = node.closest && node.closest("[role=gridcell]");
    if (!td) return null;
    const r = td.parentNode.sectionRowIndex;
    const c = td.cellIndex - 3;
    return { td, r, c, cell: rows[r].cells[first + c], variant: rows[r].variant };
  };
  if (cells.length && cells[0].length) cells[0][0].tabIndex = 0;
  const show = (event) => {
    const at = place(event.target);
    if (!at) { hideTooltip(); return; }
    if (event.type === "focusin") showTooltipAt(at.td, cellLines(at.cell, at.variant));
    else showTooltip(at.td, cellLines(at.cell, at.variant), event.clientX, event.clientY);
  };
  table.addEventListener("pointermove", show);
  table.addEventListener("focusin", show);
  table.addEventListener("pointerleave", hideTooltip);
  table.addEventListener("focusout", hideTooltip);
  const open = (event) => {
    const at = place(event.target);
    if (at && at.cell.one) showDetails([at.cell.one]);
  };
  table.addEventListener("click", open);
  table.addEventListener("keydown", (event) => {
    const at = place(event.target);
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
