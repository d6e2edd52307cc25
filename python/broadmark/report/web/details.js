// The details of a case: figures, frames and the commands that run it again.

function showDetails(selected) {
  hideTooltip();
  const dialog = byId("details");
  if (selected.length === 1) fillDetails(dialog, selected[0]);
  else fillList(dialog, selected);
  if (!dialog.open) dialog.showModal();
  dialog.scrollTop = 0;
  if (selected.length === 1) drawTimeline(dialog.querySelector("figure"), selected[0]);
}

function dialogHead(title, subtitle) {
  return element("div", { class: "dialog-head" },
    element("div", {}, element("h2", { id: "details-title" }, title), element("p", { class: "muted" }, subtitle)),
    button("Close", () => byId("details").close(), { "aria-label": "Close details" }));
}

function fillList(dialog, selected) {
  dialog.replaceChildren(
    dialogHead(plural(selected.length, "case"), selected[0].recording.title),
    element("ul", { class: "plain" }, selected.map((c) => element("li", {},
      button(nameOf(c), () => showDetails([c]), { class: "link" }), " ", statusMark(c.status),
      c.reason ? element("div", { class: "muted" }, c.reason) : null))));
}

function fillDetails(dialog, testCase) {
  const parts = element("div", {},
    dialogHead(nameOf(testCase), testCase.recording.title),
    element("p", {}, statusMark(testCase.status), testCase.reason ? `: ${testCase.reason}` : "",
            testCase.complete ? "" : ` (${statusOf(testCase)})`),
    testCase.warnings.split("; ").filter(Boolean).map((text) => element("p", { class: "notice" }, text)),
    facts("figures", figuresOf(testCase)),
    element("figure", {}),
    element("h3", {}, "Run it again"),
    ...(testCase.family === "Python" ? [element("p", { class: "muted" }, "A Python function: call broadmark.measure() with it, on this recording.")]
      : testCase.recording.command ? commandsOf(testCase)
      : [element("p", { class: "muted" }, "Boxes from Python: call broadmark.run() with them.")]),
    copyable("Hash of the recording", testCase.recording.hash || kNoValue, "hash"),
    copyable("Case", testCase.id, "id"),
    element("h3", {}, "Other values"),
    facts("particulars", particularsOf(testCase)));
  dialog.replaceChildren(parts);
}

function commandsOf(testCase) {
  return [
    testCase.address ? element("p", {}, element("a",
      { href: `${data.program_page}#${testCase.address}`, target: "_blank", rel: "noopener", "data-name": "browser" },
      "Open in a browser")) : null,
    element("p", { class: "muted" }, "Run these commands in the folder in which this page was written; paths are relative to it."),
    testCase.again_command ? copyable("From its results file, which verifies the recording",
      joined("broadmark --headless", testCase.again_command, testCase.condition_command), "again") : null,
    testCase.again_command && testCase.wrong_frames.length ? copyable("Export the smallest recording that shows the fault",
      joined("broadmark --headless", testCase.again_command, "--export-case small.aabbs"), "export") : null,
    copyable("Without the results file", joined("broadmark --headless", testCase.recording.command, testCase.variant_command, testCase.condition_command), "command"),
  ];
}

const joined = (...words) => words.filter(Boolean).join(" ");

function figuresOf(testCase) {
  const interval = testCase.ci95_low_seconds === null ? null
    : `${time(Math.max(0, testCase.ci95_low_seconds))} to ${time(testCase.ci95_high_seconds)}`;
  const best = lastRunsOn(testCase).filter((other) => isTimed(other) && !isSelfCheck(other))
    .sort((a, b) => a.seconds_per_frame - b.seconds_per_frame)[0];
  const hasMean = testCase.seconds_per_frame !== null;
  const meanFacts = [
    ["95 % interval", interval || (hasMean ? "single repetition" : kNoValue)],
    ["ratio to the best", hasMean && best && testCase.status === "ok" && !isSelfCheck(testCase)
      ? `${ratio(testCase.seconds_per_frame / best.seconds_per_frame)} × ${best.variant}` : kNoValue],
  ];
  return kFields.filter((field) => field.figure).flatMap((field) => [
    [field.title, textOfField(field, testCase)], ...(field.key === "seconds_per_frame" ? meanFacts : [])]);
}

function lastRunsOn(testCase) {
  return cases.filter((other) => other.machine === testCase.machine && other.recording === testCase.recording && !other.superseded);
}

function particularsOf(testCase) {
  const fields = kFields.filter((field) => field.particular && valueOf(field, testCase))
    .map((field) => [field.title, textOfField(field, testCase)]);
  return [
    ["machine", machines[testCase.machine].name], ["commit", factOf(machines[testCase.machine], "Commit") || ""],
    ["load before the case", testCase.load], ["algorithm", testCase.algorithm], ["family", testCase.family],
    ["parameters", testCase.params.replaceAll(";", ", ") || "none"], ["threads", testCase.threads],
    ["instruction set", testCase.isa || "not vectorised"], ["device", testCase.device],
    ["repetitions", testCase.repetitions_asked === null ? testCase.repetitions : `${testCase.repetitions} of ${testCase.repetitions_asked}`],
    ["frames", `${count(testCase.frames_run)} of ${count(testCase.recording.frames)}`], ...fields,
    ["counters", testCase.counted.replaceAll("\n", ", ")], ["results file", testCase.file],
  ].filter(([, value]) => value !== "" && value !== null);
}

function facts(name, pairs) {
  return element("dl", { class: name }, pairs.map(([title, value]) => (
    element("div", {}, element("dt", {}, title), element("dd", {}, String(value))))));
}

// A text with a copy button.
function copyable(title, text, name) {
  // Lines break only between options.
  const words = text.split(/ (?=--)/).flatMap((option) => [" ", element("span", {}, option)]).slice(1);
  const code = element("code", { "data-name": name }, words);
  return element("div", { class: "copyable" }, element("div", { class: "muted" }, title),
    element("div", { class: "row" }, code, button("Copy", (event) => copy(code, event.target),
                                                   { "aria-label": `Copy: ${title}` })));
}

async function copy(code, pressed) {
  getSelection().selectAllChildren(code);
  try {
    await navigator.clipboard.writeText(code.textContent);
  } catch (error) {  // without permission, or for a page opened from a file
    document.execCommand("copy");
  }
  pressed.textContent = "Copied";
  announce("copied");
  setTimeout(() => { pressed.textContent = "Copy"; }, 1500);
}
