// One tooltip for all: on hover and on keyboard focus.

let described = null;

function showTooltip(target, lines, x, y) {
  const tip = byId("tooltip");
  tip.replaceChildren(...lines.map((line, i) => (
    line instanceof Node ? line : element(i === 0 ? "b" : "div", {}, line))));
  tip.hidden = false;
  (target.closest("dialog") || document.body).append(tip);  // an open dialog covers all that is outside
  if (described) described.removeAttribute("aria-describedby");
  described = target;
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
  if (described) described.removeAttribute("aria-describedby");
  described = null;
}

// Beside an element that has the keyboard's focus.
function showTooltipAt(target, lines) {
  const box = target.getBoundingClientRect();
  showTooltip(target, lines, box.right - 8, box.top);
}

function caseLines(one) {
  const lines = [nameOf(one), one.on.title];
  if (machines.length > 1) lines.push(machines[one.machine].name);
  if (one.status === "ok") {
    lines.push(`${time(one[view.measure])} a frame (${measureName()})`);
    if (hasInterval(one)) {
      lines.push(`95 %: ${time(Math.max(0, one.ci95_low_seconds))} to ${time(one.ci95_high_seconds)}`);
    } else if (view.measure === "seconds_per_frame") {
      lines.push(one.repetitions > 1 ? "no interval" : "one repetition: no interval");
    }
    if (one.peak_bytes !== null) lines.push(`memory ${bytes(one.peak_bytes)}`);
    if (!one.complete) lines.push(statusOf(one));
    if (!one.checked && !isSelfCheck(one)) lines.push("answers not checked");
  } else {
    lines.push(statusMark(one.status));
    if (one.reason) lines.push(one.reason);
  }
  return lines;
}

const measureName = () => kMeasures.find(([key]) => key === view.measure)[1];

const hasInterval = (one) => view.measure === "seconds_per_frame"
  && one.ci95_low_seconds !== null && one.ci95_high_seconds !== null;
