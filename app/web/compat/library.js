// Emscripten's own fstat() looks for the file by its name: none is left of an unlinked one.
addToLibrary({
  __syscall_fstat64: (descriptor, buffer) => {
    const stream = SYSCALLS.getStreamFromFD(descriptor);
    return SYSCALLS.doStat(() => stream.node.node_ops.getattr(stream.node), stream.path, buffer);
  },
});
