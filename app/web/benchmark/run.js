// A worker that runs a program once, with the arguments of its first message.
onmessage = ({ data }) => {
  const output = [];
  let error = "";
  self.Module = {
    arguments: data.words,
    mainScriptUrlOrBlob: data.program,  // threads load the program, not this file
    print: (line) => output.push(line),
    printErr: (line) => {
      const text = line.split("\r").pop().trim();
      if (text.startsWith("broadmark: ")) error = text.slice("broadmark: ".length);
      else if (text) postMessage({ progress: text });
    },
    onExit: (status) => postMessage({ status, output: output.join("\n"), error }),
    onAbort: (reason) => postMessage({ status: -1, error: String(reason) }),
  };
  importScripts(data.program);
};
