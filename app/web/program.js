// Chooses the program for this browser.

// A module with a function that makes a vector.
const kVectorModule = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0,
                                      65, 0, 253, 15, 253, 98, 11]);

// Whether the page is isolated from others, without which browsers grant no threads. It is loaded
// again for that, once.
async function isIsolated() {
  if (crossOriginIsolated) {
    sessionStorage.removeItem("isolated");  // a forced reload passes the worker by: it may try again
    return true;
  }
  if (sessionStorage.isolated || !navigator.serviceWorker) return false;
  try {
    await navigator.serviceWorker.register("isolate.js");
    await navigator.serviceWorker.ready;
  } catch {
    return false;
  }
  sessionStorage.isolated = "tried";
  location.reload();
  return new Promise(() => {});  // the page ends
}

// Calls start(program, why): the script of the program for this browser, and why it is the slower
// one, "" if it is not.
async function withProgram(start) {
  if (!WebAssembly.validate(kVectorModule)) {
    return start("plain.js", "This browser does not support vector instructions (simd128): one thread, scalar code.");
  }
  if (await isIsolated()) return start("broadmark.js", "");
  return start("plain.js", "This page cannot use threads, which browsers allow only over https: one thread, scalar code.");
}
