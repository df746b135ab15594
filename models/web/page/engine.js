// Workers as promises: `new Engine()` starts one, `call` asks it, `cancel` ends whatever it does.

/** What a call that was canceled is rejected with. */
export class Canceled extends Error {
  constructor() {
    super('canceled');
    this.name = 'Canceled';
  }
}

export class Engine {
  #worker = null;
  #calls = new Map();
  #next = 1;
  #picture = null;

  constructor() {
    this.#start();
  }

  #start() {
    this.#worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
    this.#worker.onmessage = ({ data }) => this.#answer(data);
    this.#worker.onerror = (event) => {
      event.preventDefault();
      this.#fail(new Error(event.message || 'the worker could not be started'));
    };
  }

  #answer({ id, value, error, step, broken }) {
    const call = this.#calls.get(id);
    if (!call) return;
    if (step) {
      call.onStep?.(step);
      return;
    }
    this.#calls.delete(id);
    if (broken) {
      call.reject(new Error('the fit failed on this picture, which is a defect of dvp; please report it with the picture'));
      this.cancel();
    } else if (error !== undefined) call.reject(new Error(error));
    else call.resolve(value);
  }

  #fail(error) {
    const calls = [...this.#calls.values()];
    this.#calls.clear();
    calls.forEach((call) => call.reject(error));
  }

  /** Asks the worker; `onStep` hears of the steps of a refinement. */
  call(name, values = {}, onStep = null) {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#calls.set(id, { resolve, reject, onStep });
      this.#worker.postMessage({ ...values, id, call: name });
    });
  }

  /** Hands a picture over; after a cancel the new worker gets it again. */
  async load(picture) {
    this.#picture = picture;
    return this.call('load', picture);
  }

  /** Ends what the worker does: its calls are rejected with [`Canceled`], a new worker takes over. */
  cancel() {
    this.#worker.terminate();
    this.#fail(new Canceled());
    this.#start();
    if (this.#picture) this.call('load', this.#picture).catch(() => {});
  }
}

/** Calls of which only the newest matters: while one runs, the next waits and is replaced by later ones. */
export class Latest {
  #run;
  #waiting = null;
  #busy = false;

  /** `run` takes what is asked for; what it gives is not looked at. */
  constructor(run) {
    this.#run = run;
  }

  async ask(value) {
    this.#waiting = { value };
    if (this.#busy) return;
    this.#busy = true;
    try {
      while (this.#waiting) {
        const { value: next } = this.#waiting;
        this.#waiting = null;
        await this.#run(next);
      }
    } finally {
      this.#busy = false;
    }
  }
}
