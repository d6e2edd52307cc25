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

// The runs with cases of a variant, and those with cases on a recording, on each machine. Saved results
// may have several runs in a file.
const runsWith = new Map();
for (const testCase of cases) {
  for (const key of [`${testCase.machine} ${testCase.variant}`, testCase.recording]) {
    if (!runsWith.has(key)) runsWith.set(key, new Set());
    runsWith.get(key).add(`${testCase.started} ${testCase.file}`);
  }
}

// Whether a run has both: then the variant should have run there.
function wasAsked(machine, recording, variant) {
  const runs = runsWith.get(recording);
  return [...runsWith.get(`${machine} ${variant}`)].some((run) => runs.has(run));
}

// Squared standard errors of the logarithms of times, from the repetitions: halfway between a case's
// own and the median of these cases, as few repetitions tell little. null: unknown.
function variancesOf(column) {
  const own = column.map((c) => (view.measure === "seconds_per_frame" && c && isTimed(c) && c.standard_error !== null
    ? c.standard_error ** 2 : null));
  const usual = d3.median(own.filter((variance) => variance !== null));
  return own.map((variance) => (variance === null ? null : (variance + usual) / 2));
}

// Half the width of the 95 % interval of a ratio's logarithm; null: unknown.
const halfInterval = (a, b) => (a === null || b === null ? null : 1.96 * Math.sqrt(a + b));

// Variants and recordings of the cases on a machine, with a ratio or its absence in each cell. A gap
// counts as twice the slowest in the geometric mean, so that leaving out hard cases is no advantage;
// what was not asked for is no gap. Ratios within their uncertainty of 1 are ties.
function rank(candidates, machine) {
  const own = candidates.filter((c) => c.machine === machine && !isSelfCheck(c) && !c.superseded);
  const ranked = distinct(own.map((c) => c.recording)).sort(byRecording);
  const rows = distinct(own.map((c) => c.variant)).map((variant) => ({ variant, cells: [] }));
  for (const recording of ranked) {
    const column = rows.map(({ variant }) => findCase(machine, recording, variant));
    const times = column.filter((c) => c && isTimed(c)).map((c) => c[view.measure]);
    const best = Math.min(...times);
    const penalty = 2 * Math.max(...times) / best;
    const variances = variancesOf(column);
    const bestVariance = variances[column.findIndex((c) => c && isTimed(c) && c[view.measure] === best)];
    column.forEach((testCase, i) => {
      const timed = testCase && isTimed(testCase);
      const value = timed ? testCase[view.measure] / best : null;
      const half = timed && value > 1 ? halfInterval(variances[i], bestVariance) : null;
      rows[i].cells.push({
        testCase, recording, ratio: value, penalty, half, variance: variances[i],
        tie: timed && (value === 1 || Math.log(value) <= half),
        asked: Boolean(testCase) || wasAsked(machine, recording, rows[i].variant),
      });
    });
  }
  for (const row of rows) {
    const counted = row.cells.filter((cell) => cell.asked && Number.isFinite(cell.penalty));
    row.gaps = counted.filter((cell) => cell.ratio === null).length;
    row.recordingCount = counted.length;
    row.mean = counted.length === 0 || row.gaps === row.recordingCount ? null
      : Math.exp(d3.mean(counted, (cell) => Math.log(cell.ratio || cell.penalty)));
    row.family = row.cells.find((cell) => cell.testCase).testCase.family;
  }
  rows.sort((a, b) => (a.mean || Infinity) - (b.mean || Infinity) || (a.variant < b.variant ? -1 : 1));
  const first = rows[0];
  rows.forEach((row, i) => {
    row.tie = row.mean !== null && (i === 0 || Math.log(row.mean / first.mean) <= halfInterval(varianceOf(row), varianceOf(first)));
    row.rank = row.tie ? 1 : i + 1;
  });
  return { machine, recordings: ranked, rows };
}

// Of a row's mean; null: unknown.
function varianceOf(row) {
  const known = row.cells.filter((cell) => cell.ratio !== null).map((cell) => cell.variance);
  return known.includes(null) ? null : d3.sum(known) / known.length ** 2;
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
