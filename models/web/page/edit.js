// Edits of scenes: plain functions from one state to the next. A state is { scene, covariance }: a scene as in its JSON, and per
// object the 25 numbers of the covariance of its pose, or null. States are never changed, so undoing is going back to an older one.

const object = (state, k) => state.scene.objects[k];

/** The state with another object at `k`; what the fit knew of its numbers is forgotten where they change. */
function replaced(state, k, change, keepsKnown = false) {
  const next = { ...object(state, k), ...change };
  if (!keepsKnown) delete next.known;
  const objects = state.scene.objects.with(k, next);
  const covariance = keepsKnown ? state.covariance : state.covariance.with(k, null);
  return { scene: { ...state.scene, objects }, covariance };
}

/** Moved by so many scene units. */
export function moved(state, k, [dx, dy]) {
  const [x, y] = object(state, k).translation ?? [0, 0];
  return replaced(state, k, { translation: [x + dx, y + dy] });
}

/** Turned by `angle` (radians, from +x to +y) around a point in scene units. */
export function turned(state, k, angle, [cx, cy]) {
  const { translation: [x, y] = [0, 0], rotation = 0 } = object(state, k);
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const translation = [cx + cos * (x - cx) - sin * (y - cy), cy + sin * (x - cx) + cos * (y - cy)];
  return replaced(state, k, { translation, rotation: rotation + angle });
}

/** `factor` times as large, around a point in scene units. */
export function scaled(state, k, factor, [cx, cy]) {
  const { translation: [x, y] = [0, 0], scale = 1 } = object(state, k);
  return replaced(state, k, { translation: [cx + factor * (x - cx), cy + factor * (y - cy)], scale: scale * factor });
}

/** In another color, `#rrggbb`: one, where a ramp had many. */
export function recolored(state, k, hex) {
  const color = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  return replaced(state, k, { color, ramp: undefined }, true);
}

/** Painted at another place of the order. */
export function reordered(state, from, to) {
  const order = [...state.scene.objects.keys()];
  const last = order.length - 1;
  order.splice(Math.max(0, Math.min(last, to)), 0, order.splice(from, 1)[0]);
  return arranged(state, order);
}

/** Without an object. */
export function deleted(state, k) {
  return arranged(state, [...state.scene.objects.keys()].filter((other) => other !== k));
}

/** Objects by their old places; what doubts say of other objects follows them. */
function arranged(state, order) {
  const place = new Map(order.map((from, to) => [from, to]));
  const objects = order.map((k) => {
    const own = object(state, k);
    if (!own.known?.doubts) return own;
    const doubts = own.known.doubts
      .filter((doubt) => doubt.kind !== 'merged' || place.has(doubt.other))
      .map((doubt) => (doubt.kind === 'merged' ? { ...doubt, other: place.get(doubt.other) } : doubt));
    return { ...own, known: { ...own.known, doubts } };
  });
  return { scene: { ...state.scene, objects }, covariance: order.map((k) => state.covariance[k]) };
}

/** Every object moved, turned, scaled and colored a little: something to refine. `random` gives numbers in [0, 1). */
export function shaken(state, random) {
  const amount = (most) => (2 * random() - 1) * most;
  const shifted = (color, by) => color.map((value, c) => Math.min(1, Math.max(0, value + by[c])));
  const recolored = ({ color, ramp }) => {
    const by = color.map(() => amount(0.08));
    const stops = ramp?.stops.map((stop) => ({ ...stop, color: shifted(stop.color, by) }));
    return { color: shifted(color, by), ramp: ramp && { ...ramp, stops } };
  };
  const objects = state.scene.objects.map(({ known, ...own }) => ({
    ...own,
    translation: (own.translation ?? [0, 0]).map((x) => x + amount(0.015)),
    rotation: (own.rotation ?? 0) + amount(0.03),
    scale: (own.scale ?? 1) * Math.exp(amount(0.03)),
    ...recolored(own),
  }));
  return { scene: { ...state.scene, objects }, covariance: objects.map(() => null) };
}

/** The covariance as the module takes it: 25 numbers per object, NaN where nothing is known; none if nothing is known at all. */
export function flatCovariance(state) {
  if (state.covariance.every((block) => block === null)) return new Float32Array();
  const unknown = new Array(25).fill(NaN);
  return Float32Array.from(state.covariance.flatMap((block) => (block ?? unknown).map((value) => value ?? NaN)));
}

/** Undo and redo over states. */
export class History {
  #states = [];
  #at = -1;

  /** Begins anew. */
  reset(state) {
    this.#states = [state];
    this.#at = 0;
  }

  /** A new state; what was undone is gone. */
  push(state) {
    this.#states.length = this.#at + 1;
    this.#states.push(state);
    this.#at += 1;
  }

  get current() {
    return this.#states[this.#at] ?? null;
  }

  get canUndo() {
    return this.#at > 0;
  }

  get canRedo() {
    return this.#at + 1 < this.#states.length;
  }

  undo() {
    if (this.canUndo) this.#at -= 1;
    return this.current;
  }

  redo() {
    if (this.canRedo) this.#at += 1;
    return this.current;
  }
}
