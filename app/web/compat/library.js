// What Emscripten does otherwise, or not at all.

// Its own fstat() looks for the file by its name: none is left of an unlinked one.
addToLibrary({
  __syscall_fstat64: (descriptor, buffer) => {
    const stream = SYSCALLS.getStreamFromFD(descriptor);
    return SYSCALLS.doStat(() => stream.node.node_ops.getattr(stream.node), stream.path, buffer);
  },

  // What other programs have copied cannot be read without asking.
  $clipboard: { text: 0 },
  glfwSetClipboardString__deps: ["$clipboard", "$stringToNewUTF8", "free"],
  glfwSetClipboardString: (window, text) => {
    navigator.clipboard.writeText(UTF8ToString(text));
    _free(clipboard.text);
    clipboard.text = stringToNewUTF8(UTF8ToString(text));
  },
  glfwGetClipboardString__deps: ["$clipboard"],
  glfwGetClipboardString: (window) => clipboard.text,
});
