// A module with a function that makes a vector.
const kVectorModule = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0,
                                      65, 0, 253, 15, 253, 98, 11]);

// Calls `start` in a page that is isolated from others, without which browsers grant no threads, or
// explain(why) if it cannot be. The page is loaded again for that, once.
async function whenIsolated(start, explain) {
  if (!WebAssembly.validate(kVectorModule)) {
    return explain("Broadmark needs vectors in WebAssembly (simd128), which this browser does not have.");
  }
  if (!crossOriginIsolated) {
    if (!isSecureContext || !navigator.serviceWorker) {
      return explain("Broadmark needs threads, which a browser grants to pages over https alone.");
    }
    await navigator.serviceWorker.register("isolate.js");
    await navigator.serviceWorker.ready;
    if (sessionStorage.isolated) {
      return explain("This browser grants no threads, which Broadmark needs.");
    }
    sessionStorage.isolated = "tried";
    return location.reload();
  }
  sessionStorage.removeItem("isolated");  // a forced reload passes the worker by: it may try again
  return start();
}
