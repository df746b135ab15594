// The module in a thread of its own: pages stay awake while it works, and end it to cancel.
//
// In: { id, call, ... }. Out: { id, value } or { id, error }; while a refinement runs also { id, step }. Two of these run: one fits and
// refines, one draws and measures.
import init, { Drawing, Picture } from './dvp/dvp_wasm.js';

let picture = null;
let ready = init();

const calls = {
  /** Takes the pixels of a picture; says whether it lets through what is behind. */
  load({ rgba, width, height, coded }) {
    picture?.free();
    picture = null;
    picture = new Picture(rgba, width, height, coded);
    return { transparent: picture.transparent };
  },

  fit({ maxObjects, bank }) {
    const start = performance.now();
    const fitted = JSON.parse(picture.fit(maxObjects, bank));
    return { ...fitted, ms: performance.now() - start };
  },

  refine({ scene, bank, maxSteps }, id) {
    return withDrawing(scene, bank, (drawing) => {
      const start = performance.now();
      const told = (step, loss, json) =>
        postMessage({ id, step: { step, loss, scene: JSON.parse(json), ms: performance.now() - start } });
      return JSON.parse(picture.refine(drawing, maxSteps, told));
    });
  },

  /** What the page shows of a scene: its SVG and the measures of its objects. */
  draw({ scene, bank, covariance }) {
    return withDrawing(scene, bank, (drawing) => ({
      svg: drawing.toSvg(),
      measures: JSON.parse(drawing.measures(covariance)),
    }));
  },

  /** How far a scene is from the picture. */
  compare({ scene, bank }) {
    return withDrawing(scene, bank, (drawing) => {
      const comparison = picture.compare(drawing);
      const value = { mae: comparison.mae, differences: comparison.differences };
      comparison.free();
      return value;
    });
  },

  paint({ scene, bank, width, height }) {
    return withDrawing(scene, bank, (drawing) => ({ pixels: drawing.paint(width, height), width, height }));
  },

  table({ scene, bank, covariance, name }) {
    return withDrawing(scene, bank, (drawing) => drawing.toCsv(name, covariance));
  },

  /** Fits a small picture of many kinds of edges, so that the browser has compiled the module before it matters. */
  warm() {
    const side = 64;
    const rgba = new Uint8Array(4 * side * side).fill(255);
    for (let i = 0; i < side * side; i++) {
      const [x, y] = [i % side, Math.floor(i / side)];
      const disk = Math.min(1, Math.max(0, 15.5 - Math.hypot(x - 22, y - 24)));
      if (x > 30 && y > 34 && x < 58 && y < 54) rgba.set([30, 120, 90], 4 * i);
      else if (disk > 0) rgba.set([255 - 55 * disk, 255 - 200 * disk, 255 - 200 * disk], 4 * i);
    }
    const small = new Picture(rgba, side, side, false);
    small.fit(256, '');
    small.free();
    return true;
  },
};

function withDrawing(scene, bank, use) {
  const drawing = new Drawing(JSON.stringify(scene), bank);
  try {
    return use(drawing);
  } finally {
    drawing.free();
  }
}

onmessage = async ({ data }) => {
  try {
    await ready;
    postMessage({ id: data.id, value: calls[data.call](data, data.id) });
  } catch (error) {
    // A panic leaves the module in pieces; errors of dvp are plain and leave it whole.
    postMessage({ id: data.id, error: error.message, broken: error instanceof WebAssembly.RuntimeError });
  }
};
