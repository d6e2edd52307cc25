// What the program finds when it starts: in a browser the page's canvas, and the arguments of the
// address: page.html#ARGUMENT&ARGUMENT…; in node the current folder.
const isThread = typeof ENVIRONMENT_IS_PTHREAD !== "undefined" && ENVIRONMENT_IS_PTHREAD;
if (ENVIRONMENT_IS_NODE && !isThread) {
  Module.preRun = () => {
    FS.mkdir("/here");
    FS.mount(NODEFS, { root: "." }, "/here");
    FS.chdir("/here");
  };
} else if (ENVIRONMENT_IS_WEB) {
  Module.canvas = document.getElementById("canvas");
  Module.arguments = location.hash.slice(1).split("&").filter(Boolean).map(decodeURIComponent);
  Module.preRun = () => {
    ENV.DISPLAY = "canvas";
    ENV.BROADMARK_PAGE = location.origin + location.pathname;
    FS.symlink("/bin/broadmark", "/proc/self/exe");
    FS.mkdirTree("/bin/plugins");
    FS.writeFile("/bin/plugins/find-the-bug.so", "");
    FS.chdir("/home/web_user");
    restore();
    // What is written here is saved by the browser. Files are complete once they have their name.
    const { rename, unlink } = FS;
    FS.rename = (from, to) => {
      rename(from, to);
      const { path } = FS.lookupPath(to);
      if (isKept(path)) localStorage.setItem(path, FS.readFile(path, { encoding: "utf8" }));
      else if (/^\/home\/web_user\/[^.][^/]*$/.test(path)) save(to);
    };
    FS.unlink = (path) => {
      unlink(path);
      localStorage.removeItem(path);
    };
  };
  // Preferences and unsaved scenes outlive the page.
  const isKept = (path) => /^\/home\/web_user\/\.(config|local)\/.*\.json$/.test(path);
  const restore = () => {
    for (const [path, text] of Object.entries(localStorage).filter(([key]) => isKept(key))) {
      FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
      // Files that were open are gone.
      const recent = /"recent": *\[[^\]]*\]/;
      FS.writeFile(path, path.includes("/.config/") ? text.replace(recent, '"recent": []') : text);
    }
  };
  const save = (path) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([FS.readFile(path)]));
    link.download = path.split("/").pop();
    link.click();
    URL.revokeObjectURL(link.href);
  };
  Module.postRun = () => {
    const fit = () => Browser.setCanvasSize(innerWidth, innerHeight);
    addEventListener("resize", fit);
    fit();
  };
}
