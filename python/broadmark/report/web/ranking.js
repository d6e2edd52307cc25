// Ratios to the best, per machine and recording, never across machines.

// The last run of each case, by machine, recording and variant. Charts show only these.
const lastRuns = new Map();
const keyOf = (machine, recording, variant) => `${machine} ${recording.index} ${variant}`;

function markLastRuns(candidates) {
  lastRuns.clear();
  for (const testCase of candidates) lastRuns.set(keyOf(testCase.machine, testCase.recording, testCase.variant), testCase);
  for (const testCase of cases) testCase.superseded = findCase(testCase.machine, testCase.recording, testCase.variant) !== testCase;
}

const findCase = (machine, recording, variant) => lastRuns.get(keyOf(machine, recording, variant));

markLastRuns(cases);

const distinct = (values) => [...new Set(values)];

// Variants and recordings of the cases on a machine, with a ratio or its absence in each cell. A gap
// counts as twice the slowest in the geometric mean, so that leaving out hard cases is no advantage.
function rank(candidates, machine) {
  const own = candidates.filter((c) => c.machine === machine && !isSelfCheck(c) && !c.superseded);
  const ranked = distinct(own.map((c) => c.recording)).sort(byRecording);
  const rows = distinct(own.map((c) => c.variant)).map((variant) => ({ variant, cells: [] }));
  for (const recording of ranked) {
    const column = rows.map(({ variant }) => findCase(machine, recording, variant));
    const times = column.filter((c) => c && isTimed(c)).map((c) => c[view.measure]);
    const best = Math.min(...times);
    const penalty = 2 * Math.max(...times) / best;
    column.forEach((testCase, i) => {
      const timed = testCase && isTimed(testCase);
      rows[i].cells.push({ testCase, recording, ratio: timed ? testCase[view.measure] / best : null, penalty });
    });
  }
  for (const row of rows) {
    const counted = row.cells.filter((cell) => Number.isFinite(cell.penalty));
    row.gaps = counted.filter((cell) => cell.ratio === null).length;
    row.recordingCount = counted.length;
    row.mean = counted.length === 0 || row.gaps === row.recordingCount ? null
      : Math.exp(d3.mean(counted, (cell) => Math.log(cell.ratio || cell.penalty)));
    row.family = row.cells.find((cell) => cell.testCase).testCase.family;
  }
  rows.sort((a, b) => (a.mean || Infinity) - (b.mean || Infinity) || (a.variant < b.variant ? -1 : 1));
  return { machine, recordings: ranked, rows };
}

function byRecording(a, b) {
  const text = (recording) => [recording.scene, recording.object_type, recording.setting].join("\0");
  return text(a) < text(b) ? -1 : text(a) > text(b) ? 1 : a.objects - b.objects || a.index - b.index;
}

// The best variant of each family, over all machines shown.
function bestOfFamilies(rankings) {
  const best = new Map();
  for (const { rows } of rankings) {
    for (const row of rows) {
      const known = best.get(row.family);
      if (!known || (row.mean || Infinity) < known.mean) {
        best.set(row.family, { variant: row.variant, mean: row.mean || Infinity });
      }
    }
  }
  return new Set([...best.values()].map((entry) => entry.variant));
}
