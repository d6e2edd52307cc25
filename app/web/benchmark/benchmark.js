// The benchmark page: runs the program in a worker, and shows its results in the report page beside
// the published ones.
"use strict";

const byId = (id) => document.getElementById(id);
const say = (text) => { byId("progress").textContent = text; };

// "Chrome 131": the brand that a browser tells, or what its address of the user agent holds.
function browserName() {
  const brand = navigator.userAgentData?.brands.find(({ brand: name }) => !/Not.A.Brand|^Chromium$/.test(name))
    || navigator.userAgentData?.brands.find(({ brand: name }) => name === "Chromium");
  if (brand) return `${brand.brand} ${brand.version}`;
  const [, name, version] = navigator.userAgent.match(/(Firefox|Edg|Chrome|Version)\/(\d+)/) || [0, "browser", ""];
  return `${name === "Version" ? "Safari" : name} ${version}`.trim();
}

// Runs the program with these arguments. Resolves to its results.
function measured(program, words) {
  return new Promise((resolve, reject) => {
    const worker = new Worker("run.js");
    worker.onmessage = ({ data }) => {
      if (data.progress) say(data.progress);
      if (data.status === undefined) return;
      worker.terminate();
      if (data.status === 0) resolve(JSON.parse(data.output));
      else reject(new Error(data.error || `the program ended with status ${data.status}`));
    };
    worker.onerror = (event) => reject(new Error(event.message));
    worker.postMessage({ program, words });
  });
}

// States where it was measured: the program knows no more than that it runs in a browser.
function named(results) {
  for (const environment of results.environments) {
    environment.host = browserName();
    environment.cpu = byId("processor").value || `unknown, ${navigator.hardwareConcurrency} logical cores`;
    environment.logical_cores = navigator.hardwareConcurrency;
    environment.os = `${browserName()}, ${navigator.userAgentData?.platform || navigator.platform}`;
  }
  return results;
}

async function textOf(address) {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status}`);
  return response.text();
}

async function run(program) {
  byId("run").disabled = true;
  try {
    const [report, words] = await Promise.all([textOf("published.html"), textOf("arguments.txt")]);
    const results = named(await measured(program, words.trim().split(/\s+/)));
    byId("report").srcdoc = withCases(report, results);
    byId("report").hidden = false;
    say(`Done: ${results.cases.filter(({ status }) => status === "ok").length} of ${results.cases.length} cases are correct.`);
    byId("save").hidden = false;
    byId("save").onclick = () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([JSON.stringify(results)], { type: "application/json" }));
      link.download = "browser.json";
      link.click();
      URL.revokeObjectURL(link.href);
    };
    window.results = results;  // for tests
  } catch (error) {
    say(`Measuring failed: ${error.message}.`);
  }
  byId("run").disabled = false;
}

withProgram((program, why) => {
  say(why);
  byId("run").addEventListener("click", () => run(program));
});
