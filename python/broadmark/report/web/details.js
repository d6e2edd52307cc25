// The panel of a case: its figures, its frames, and the commands that run it again.

function showDetails(some) {
  hideTooltip();
  const dialog = byId("details");
  if (some.length === 1) fillDetails(dialog, some[0]);
  else fillList(dialog, some);
  if (!dialog.open) dialog.showModal();
  dialog.scrollTop = 0;
  if (some.length === 1) drawTimeline(dialog.querySelector("figure"), some[0]);
}

function dialogHead(title, subtitle) {
  return element("div", { class: "dialog-head" },
    element("div", {}, element("h2", { id: "details-title" }, title), element("p", { class: "muted" }, subtitle)),
    button("Close", () => byId("details").close(), { "aria-label": "Close details" }));
}

function fillList(dialog, some) {
  dialog.replaceChildren(
    dialogHead(plural(some.length, "case"), some[0].on.title),
    element("ul", { class: "plain" }, some.map((one) => element("li", {},
      button(nameOf(one), () => showDetails([one]), { class: "link" }), " ", statusMark(one.status),
      one.reason ? element("div", { class: "muted" }, one.reason) : null))));
}

function fillDetails(dialog, one) {
  const parts = element("div", {},
    dialogHead(nameOf(one), one.on.title),
    element("p", {}, statusMark(one.status), one.reason ? `: ${one.reason}` : "",
            one.complete ? "" : ` (${statusOf(one)})`),
    one.warnings.split("; ").filter(Boolean).map((text) => element("p", { class: "notice" }, text)),
    facts("figures", figuresOf(one)),
    element("figure", {}),
    element("h3", {}, "Run it again"),
    element("p", { class: "muted" }, "In the folder that this page was written from; files are named as seen from there."),
    copyable("From its results file, which checks that the recording is the same",
             joined("broadmark --headless", one.again_command, one.condition_command), "again"),
    one.wrong_frames.length ? copyable("The smallest recording that shows the fault",
      joined("broadmark --headless", one.again_command, "--export-case small.aabbs"), "export") : null,
    copyable("By itself", joined("broadmark --headless", one.on.command, one.variant_command, one.condition_command), "command"),
    copyable("Hash of the recording", one.on.hash || kNothing, "hash"),
    copyable("Case", one.id, "id"),
    element("h3", {}, "Particulars"),
    facts("particulars", particularsOf(one)));
  dialog.replaceChildren(parts);
}

const joined = (...words) => words.filter(Boolean).join(" ");

function figuresOf(one) {
  const interval = one.ci95_low_seconds === null ? null
    : `${time(Math.max(0, one.ci95_low_seconds))} to ${time(one.ci95_high_seconds)}`;
  const better = lastRunsOn(one).filter((other) => isTimed(other) && !isSelfCheck(other))
    .sort((a, b) => a.seconds_per_frame - b.seconds_per_frame)[0];
  const shown = one.seconds_per_frame !== null;
  const beside = [
    ["95 % interval", interval || (shown ? "one repetition" : kNothing)],
    ["to the best here", shown && better && one.status === "ok" && !isSelfCheck(one)
      ? `${ratio(one.seconds_per_frame / better.seconds_per_frame)} × ${better.variant}` : kNothing],
  ];
  return kFields.filter((field) => field.figure).flatMap((field) => [
    [field.title, textOfField(field, one)], ...(field.key === "seconds_per_frame" ? beside : [])]);
}

function lastRunsOn(one) {
  return cases.filter((other) => other.machine === one.machine && other.recording === one.recording && !other.superseded);
}

function particularsOf(one) {
  const measured = kFields.filter((field) => field.particular && valueOf(field, one))
    .map((field) => [field.title, textOfField(field, one)]);
  return [
    ["machine", machines[one.machine].name], ["algorithm", one.algorithm], ["family", one.family],
    ["parameters", one.params.replaceAll(";", ", ") || "none"], ["threads", one.threads],
    ["instruction set", one.isa || "does not depend on it"], ["device", one.device],
    ["repetitions", one.repetitions_asked === null ? one.repetitions : `${one.repetitions} of ${one.repetitions_asked}`],
    ["frames", `${count(one.frames_run)} of ${count(one.on.frames)}`], ...measured,
    ["counted", one.counted.replaceAll("\n", ", ")], ["results file", one.file],
  ].filter(([, value]) => value !== "" && value !== null);
}

function facts(name, pairs) {
  return element("dl", { class: name }, pairs.map(([title, value]) => (
    element("div", {}, element("dt", {}, title), element("dd", {}, String(value))))));
}

// A text with a button that copies it.
function copyable(title, text, name) {
  // A line breaks between options, never in the dashes of one.
  const words = text.split(/ (?=--)/).flatMap((word) => [" ", element("span", {}, word)]).slice(1);
  const code = element("code", { "data-name": name }, words);
  return element("div", { class: "copyable" }, element("div", { class: "muted" }, title),
    element("div", { class: "row" }, code, button("Copy", (event) => copy(code, event.target),
                                                   { "aria-label": `Copy: ${title}` })));
}

async function copy(code, pressed) {
  getSelection().selectAllChildren(code);
  try {
    await navigator.clipboard.writeText(code.textContent);
  } catch (error) {  // no permission, or a page opened from a file
    document.execCommand("copy");
  }
  pressed.textContent = "Copied";
  speak("copied");
  setTimeout(() => { pressed.textContent = "Copy"; }, 1500);
}
