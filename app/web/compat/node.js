// In node, files are those of the current folder.
if (ENVIRONMENT_IS_NODE && !ENVIRONMENT_IS_PTHREAD) {
  Module.preRun = () => {
    FS.mkdir("/here");
    FS.mount(NODEFS, { root: "." }, "/here");
    FS.chdir("/here");
  };
}
