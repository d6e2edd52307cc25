// An algorithm as a program, for --external: sort and sweep along one axis (Ericson 2005, 7.5).
// The protocol: docs/external.md.
//
//   broadmark --headless freefall --external 'node sweep.js' --algorithm js-sweep
'use strict';
const fs = require('fs');
const readline = require('readline');

const BOX = 8; // floats: min x y z 0, max x y z 0
let axis = 0;
let frames, answers; // files
let boxes, order;
let pairs = new Uint32Array(1024);

const calls = {
  describe: () => ({
    version: 1,
    id: 'js-sweep',
    family: 'JavaScript sweep',
    summary: 'sort and sweep along one axis, written in JavaScript',
    principle: 'sorting',
    time: 'O(n log n + w), w pairs that overlap on the axis',
    space: 'O(n + k)',
    source: 'Ericson 2005, 7.5',
    parameters: [{name: 'axis', doc: 'the axis that is swept: 0, 1 or 2', value: 0, min: 0, max: 2, integer: true}],
  }),

  start: ({frames_file, pairs_file, max_bodies, parameters}) => {
    axis = parameters.axis;
    frames = fs.openSync(frames_file, 'r');
    answers = fs.openSync(pairs_file, 'r+');
    boxes = new Float32Array(BOX * max_bodies);
    order = new Uint32Array(max_bodies);
    return {};
  },

  frame: ({bodies}) => {
    fs.readSync(frames, boxes, 0, 4 * BOX * bodies, 0);
    const start = process.hrtime.bigint();
    const count = findPairs(bodies);
    const seconds = Number(process.hrtime.bigint() - start) * 1e-9;
    fs.writeSync(answers, pairs, 0, 8 * count, 0);
    return {pairs: count, seconds};
  },
};

function findPairs(bodies) {
  const ids = order.subarray(0, bodies);
  for (let i = 0; i < bodies; ++i) ids[i] = i;
  ids.sort((a, b) => boxes[BOX * a + axis] - boxes[BOX * b + axis]);
  let count = 0;
  for (let i = 0; i < bodies; ++i) {
    const a = ids[i];
    const max = boxes[BOX * a + 4 + axis];
    for (let j = i + 1; j < bodies && boxes[BOX * ids[j] + axis] <= max; ++j) {
      const b = ids[j];
      if (!overlap(BOX * a, BOX * b)) continue;
      if (pairs.length < 2 * count + 2) {
        const grown = new Uint32Array(2 * pairs.length);
        grown.set(pairs);
        pairs = grown;
      }
      pairs[2 * count] = Math.min(a, b);
      pairs[2 * count + 1] = Math.max(a, b);
      ++count;
    }
  }
  return count;
}

function overlap(a, b) {
  return boxes[a] <= boxes[b + 4] && boxes[b] <= boxes[a + 4] &&
    boxes[a + 1] <= boxes[b + 5] && boxes[b + 1] <= boxes[a + 5] &&
    boxes[a + 2] <= boxes[b + 6] && boxes[b + 2] <= boxes[a + 6];
}

readline.createInterface({input: process.stdin}).on('line', (line) => {
  let reply;
  try {
    const message = JSON.parse(line);
    reply = calls[message.call](message);
  } catch (error) {
    reply = {error: String(error)};
  }
  fs.writeSync(1, JSON.stringify(reply) + '\n');
});
