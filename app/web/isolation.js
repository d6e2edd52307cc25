// Calls `start` in a page that is isolated from others, without which browsers grant no threads, or
// explain(why) if it cannot be. The page is loaded again for that, once.
async function whenIsolated(start, explain) {
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
