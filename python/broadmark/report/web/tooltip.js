// The page's only tooltip, shown on hover and on keyboard focus.

let tooltipTarget = null;

function showTooltip(target, lines, x, y) {
  const tip = byId("tooltip");
  tip.replaceChildren(...lines.map((line, i) => (
    line instanceof Node ? line : element(i === 0 ? "b" : "div", {}, line))));
  tip.hidden = false;
  (target.closest("dialog") || document.body).append(tip);  // an open dialog covers elements outside
  if (tooltipTarget) tooltipTarget.removeAttribute("aria-describedby");
  tooltipTarget = target;
  target.setAttribute("aria-describedby", "tooltip");
  const own = tip.getBoundingClientRect();
  const width = document.documentElement.clientWidth;
  const left = Math.max(4, Math.min(x + 14, width - own.width - 4));
  const above = y - own.height - 12;
  tip.style.setProperty("left", `${left}px`);
  tip.style.setProperty("top", `${above > 4 ? above : y + 18}px`);
}

function hideTooltip() {
  byId("tooltip").hidden = true;
  if (tooltipTarget) tooltipTarget.removeAttribute("aria-describedby");
  tooltipTarget = null;
}

// Shows the tooltip at an element with keyboard focus.
function showTooltipAt(target, lines) {
  const box = target.getBoundingClientRect();
  showTooltip(target, lines, box.right - 8, box.top);
}

function caseLines(testCase) {
  const lines = [nameOf(testCase), testCase.recording.title];
  if (machines.length > 1) lines.push(machines[testCase.machine].name);
  if (testCase.status === "ok") {
    lines.push(`${time(testCase[view.measure])} per frame (${measureName()})`);
    if (hasInterval(testCase)) {
      lines.push(`95 %: ${time(Math.max(0, testCase.ci95_low_seconds))} to ${time(testCase.ci95_high_seconds)}`);
    } else if (view.measure === "seconds_per_frame") {
      lines.push(testCase.repetitions > 1 ? "no interval" : "single repetition: no interval");
    }
    if (testCase.peak_bytes !== null) lines.push(`memory ${bytes(testCase.peak_bytes)}`);
    if (!testCase.complete) lines.push(statusOf(testCase));
    if (!testCase.checked && !isSelfCheck(testCase)) lines.push("answers not checked");
  } else {
    lines.push(statusMark(testCase.status));
    if (testCase.reason) lines.push(testCase.reason);
  }
  return lines;
}

const measureName = () => kMeasures.find(([key]) => key === view.measure)[1];

const hasInterval = (c) => view.measure === "seconds_per_frame"
  && c.ci95_low_seconds !== null && c.ci95_high_seconds !== null;
