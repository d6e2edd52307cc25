// Formatting of numbers with units and three digits.

const kNoValue = "–";

function digits(value) {
  if (value >= 100) return value.toFixed(0);
  return value >= 10 ? value.toFixed(1) : value.toFixed(2);
}

function withUnit(value, units) {
  for (const [size, unit] of units) {
    if (Math.abs(value) >= size * 0.9995) return digits(value / size) + "\u00a0" + unit;
  }
  const [size, unit] = units[units.length - 1];
  return digits(value / size) + "\u00a0" + unit;
}

const kTimes = [[1, "s"], [1e-3, "ms"], [1e-6, "µs"], [1e-9, "ns"]];
const kSizes = [[2 ** 30, "GiB"], [2 ** 20, "MiB"], [2 ** 10, "KiB"]];

function time(seconds) {
  if (seconds === null || seconds === undefined) return kNoValue;
  return seconds === 0 ? "0\u00a0s" : (seconds < 0 ? "−" : "") + withUnit(Math.abs(seconds), kTimes);
}

function bytes(size) {
  if (size === null || size === undefined) return kNoValue;
  return size === 0 ? "0\u00a0KiB" : withUnit(size, kSizes);
}

const kIntegerFormat = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const kDecimalFormat = new Intl.NumberFormat("en", { maximumFractionDigits: 1 });

function count(value) {
  if (value === null || value === undefined) return kNoValue;
  if (typeof value !== "number") return String(value);
  return (value < 100 ? kDecimalFormat : kIntegerFormat).format(value);
}

function ratio(value) {
  if (value >= 9999.5) return count(Math.round(value));
  return value >= 100 ? value.toFixed(0) : value >= 10 ? value.toFixed(1) : value.toFixed(2);
}

// A tick label of a logarithmic axis: 10 µs, 64 KiB.
function shortUnit(value, units) {
  const [size, unit] = units.find(([size]) => value >= size * 0.9995) || units[units.length - 1];
  return `${+(value / size).toPrecision(3)}\u00a0${unit}`;
}

function plural(number, singular, pluralForm = singular + "s") {
  return `${count(number)} ${number === 1 ? singular : pluralForm}`;
}
