// Fit as you look: the steps of a refinement, shown one by one, with the curve of the loss.

const SVG = 'http://www.w3.org/2000/svg';
/** Frames between steps, at first: the eye wants to see what moves. */
const FIRST_MS = 40;
/** A long refinement is shown in about this time. */
const MOST_MS = 5000;

export class LossCurve {
  #figure;
  #losses = [];

  constructor(figure) {
    this.#figure = figure;
  }

  reset() {
    this.#losses = [];
    this.#figure.hidden = true;
  }

  add(loss) {
    this.#losses.push(loss);
    this.#figure.hidden = false;
    this.#draw();
    if (this.#losses.length === 1) this.#figure.scrollIntoView({ block: 'nearest' });
  }

  #draw() {
    const [width, height, margin] = [300, 96, 6];
    const logs = this.#losses.map((loss) => Math.log10(Math.max(loss, 1e-12)));
    const [least, most] = [Math.min(...logs), Math.max(...logs)];
    const x = (k) => margin + ((width - 2 * margin) * k) / Math.max(1, logs.length - 1);
    const y = (log) => margin + (height - 2 * margin) * (most === least ? 0.5 : (most - log) / (most - least));
    const line = document.createElementNS(SVG, 'polyline');
    line.setAttribute('points', logs.map((log, k) => `${x(k).toFixed(1)},${y(log).toFixed(1)}`).join(' '));
    const dot = document.createElementNS(SVG, 'circle');
    const last = logs.length - 1;
    Object.entries({ cx: x(last), cy: y(logs[last]), r: 3 }).forEach(([name, value]) => dot.setAttribute(name, value));
    this.#figure.querySelector('svg').replaceChildren(line, dot);
    const text = (loss) => loss.toExponential(2);
    this.#figure.querySelector('figcaption').textContent =
      `Mean squared error ${text(this.#losses[0])} → ${text(this.#losses[last])} in ${last} steps, logarithmic`;
  }
}

/** Shows steps as they come, none faster than the eye follows; resolves when the last one was shown. */
export class Player {
  #steps = [];
  #ended = false;
  #stopped = false;
  #show;

  constructor(show) {
    this.#show = show;
  }

  push(step) {
    this.#steps.push(step);
  }

  end() {
    this.#ended = true;
  }

  /** Shows nothing more. */
  stop() {
    this.#stopped = true;
  }

  async play() {
    const start = performance.now();
    while (!this.#stopped && !(this.#ended && this.#steps.length === 0)) {
      await new Promise(requestAnimationFrame);
      if (this.#steps.length === 0 || this.#stopped) continue;
      // Behind the worker: several at once, so that the whole does not take forever.
      const left = Math.max(FIRST_MS, MOST_MS - (performance.now() - start));
      const count = Math.max(1, Math.ceil((this.#steps.length * FIRST_MS) / left));
      const shown = this.#steps.splice(0, count);
      await this.#show(shown);
      await new Promise((resolve) => setTimeout(resolve, FIRST_MS - 16));
    }
  }
}
