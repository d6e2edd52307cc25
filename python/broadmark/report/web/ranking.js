// Ratios to the best: within one machine and one recording, never across machines.

// The last run of each case, by machine, recording and variant: charts show no other.
const lastRuns = new Map();
const keyOf = (machine, recording, variant) => `${machine} ${recording} ${variant}`;

function takeLastRuns(some) {
  lastRuns.clear();
  for (const one of some) lastRuns.set(keyOf(one.machine, one.recording, one.variant), one);
  for (const one of cases) one.superseded = findCase(one.machine, one.recording, one.variant) !== one;
}

const findCase = (machine, recording, variant) => lastRuns.get(keyOf(machine, recording, variant));

takeLastRuns(cases);

const distinct = (values) => [...new Set(values)];

// Variants and recordings of these cases on a machine, with a ratio or the reason for none in each
// cell. A gap counts as twice the slowest in the geometric mean, so that leaving out what is hard
// wins nothing.
function rank(some, machine) {
  const own = some.filter((one) => one.machine === machine && !isSelfCheck(one) && !one.superseded);
  const on = distinct(own.map((one) => one.recording)).map((number) => recordings[number]);
  on.sort(byRecording);
  const rows = distinct(own.map((one) => one.variant)).map((variant) => ({ variant, cells: [] }));
  const compared = [];
  for (const recording of on) {
    const column = rows.map(({ variant }) => findCase(machine, recording.index, variant));
    const times = column.filter((one) => one && isTimed(one)).map((one) => one[view.measure]);
    const best = Math.min(...times);
    const punished = 2 * Math.max(...times) / best;
    if (times.length) compared.push(recording);
    column.forEach((one, i) => {
      const timed = one && isTimed(one);
      rows[i].cells.push({ one, recording, ratio: timed ? one[view.measure] / best : null, punished });
    });
  }
  for (const row of rows) {
    const counted = row.cells.filter((cell) => Number.isFinite(cell.punished));
    row.gaps = counted.filter((cell) => cell.ratio === null).length;
    row.of = counted.length;
    row.mean = counted.length === 0 || row.gaps === row.of ? null
      : Math.exp(d3.mean(counted, (cell) => Math.log(cell.ratio || cell.punished)));
    row.any = row.cells.find((cell) => cell.one).one;
  }
  rows.sort((a, b) => (a.mean || Infinity) - (b.mean || Infinity) || (a.variant < b.variant ? -1 : 1));
  return { machine, recordings: on, rows };
}

function byRecording(a, b) {
  const text = (one) => [one.scene, one.object_type, one.setting].join("\0");
  return text(a) < text(b) ? -1 : text(a) > text(b) ? 1 : a.objects - b.objects || a.index - b.index;
}

// The best variant of each family, over all machines that are shown.
function bestOfFamilies(rankings) {
  const best = new Map();
  for (const { rows } of rankings) {
    for (const row of rows) {
      const { family } = row.any;
      const known = best.get(family);
      if (!known || (row.mean || Infinity) < known.mean) {
        best.set(family, { variant: row.variant, mean: row.mean || Infinity });
      }
    }
  }
  return new Set([...best.values()].map((one) => one.variant));
}
