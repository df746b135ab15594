// The panes: the picture, what was found, outlines and errors over one another, and what hands do there.
//
// `stage.on(name, heard)`: 'hover' and 'select' (object or null), 'gesture' ({ kind: 'move' | 'turn' | 'scale', ... }), 'settle'.
import { View } from './view.js';
import { Handles } from './handles.js';

const SVG = 'http://www.w3.org/2000/svg';

/** Width of the thumb of the wipe, CSS pixels, as in the style sheet. */
const THUMB = 28;

/** What is seen in each mode: one list of layers per pane. */
const MODES = {
  beside: [['picture'], ['result']],
  wipe: [['picture', 'result']],
  outlines: [['picture', 'outlines']],
  result: [['result']],
  error: [['error']],
};

export class Stage {
  #root;
  #panes = [];
  #heard = new Map();
  #mode = 'beside';
  #picture = null;
  #drawn = null;
  #error = null;
  #hovered = null;
  #selected = null;
  #pointers = new Map();
  #drag = null;
  #handles = new Handles();
  #wipe = 0.5;

  constructor(root) {
    this.#root = root;
    this.view = new View(() => this.#place());
    new ResizeObserver(() => this.#resize()).observe(root);
    root.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    root.addEventListener('pointerdown', (event) => this.#down(event));
    root.addEventListener('pointermove', (event) => this.#move(event));
    for (const name of ['pointerup', 'pointercancel']) root.addEventListener(name, (event) => this.#up(event));
    root.addEventListener('pointerleave', () => this.#tell('hover', null));
    root.addEventListener('dblclick', () => this.view.fit());
    this.mode = 'beside';
  }

  on(name, heard) {
    this.#heard.set(name, heard);
  }

  #tell(name, value) {
    this.#heard.get(name)?.(value);
  }

  get mode() {
    return this.#mode;
  }

  set mode(mode) {
    this.#mode = mode;
    this.#root.dataset.mode = mode;
    this.#panes = MODES[mode].map((layers) => this.#pane(layers));
    this.#root.replaceChildren(...this.#panes.map((pane) => pane.root));
    this.#resize();
    this.#fill();
  }

  /** Shows a picture; what was found in another one is gone. */
  show(bitmap) {
    this.#picture = bitmap;
    this.#drawn = null;
    this.#error = null;
    this.view.show(bitmap.width, bitmap.height);
    this.#fill();
  }

  /** Shows what was found: the text of an SVG, and the measures of its objects. */
  draw(svg, measures) {
    const root = new DOMParser().parseFromString(svg, 'image/svg+xml').documentElement;
    this.#drawn = { root, measures };
    this.#panes.forEach((pane) => this.#fillDrawn(pane));
    this.#place();
  }

  /** Shows differences per pixel: bytes, in steps of 1/255. */
  showError(differences) {
    this.#error = differences;
    this.#panes.forEach((pane) => this.#fillError(pane));
  }

  set hovered(k) {
    this.#hovered = k;
    this.#mark();
  }

  set selected(k) {
    this.#selected = k;
    this.#mark();
    this.#place();
  }

  /** Where the wipe stands, as a share of the way that the thumb of its slider has across the pane. */
  set wipe(share) {
    this.#wipe = share;
    this.#place();
  }

  #pane(layers) {
    const root = document.createElement('div');
    root.className = 'pane';
    const sheet = document.createElement('div');
    sheet.className = 'sheet';
    const pane = { root, sheet, layers: {} };
    for (const name of layers) {
      const tag = name === 'picture' || name === 'error' ? 'canvas' : 'div';
      pane.layers[name] = sheet.appendChild(document.createElement(tag));
      pane.layers[name].className = `layer ${name}`;
    }
    // What hands touch: the outlines, seen or not.
    pane.touch = sheet.appendChild(document.createElement('div'));
    pane.touch.className = 'layer touch';
    pane.handles = root.appendChild(document.createElementNS(SVG, 'svg'));
    pane.handles.classList.add('handles');
    root.append(sheet, pane.handles);
    return pane;
  }

  #resize() {
    const box = this.#panes[0]?.root.getBoundingClientRect();
    if (box?.width) this.view.resize(box.width, box.height);
  }

  #fill() {
    if (!this.#picture) return;
    const { width, height } = this.#picture;
    for (const pane of this.#panes) {
      Object.assign(pane.sheet.style, { width: `${width}px`, height: `${height}px` });
      if (pane.layers.picture) {
        Object.assign(pane.layers.picture, { width, height });
        pane.layers.picture.getContext('2d').drawImage(this.#picture, 0, 0);
      }
      this.#fillDrawn(pane);
      this.#fillError(pane);
    }
    this.#place();
  }

  #fillDrawn(pane) {
    const root = this.#drawn?.root;
    pane.layers.result?.replaceChildren(...(root ? [named(root, true)] : []));
    pane.layers.outlines?.replaceChildren(...(root ? [named(root, false)] : []));
    pane.touch.replaceChildren(...(root ? [named(root, false)] : []));
    this.#mark();
  }

  #fillError(pane) {
    const canvas = pane.layers.error;
    if (!canvas || !this.#picture) return;
    const { width, height } = this.#picture;
    Object.assign(canvas, { width, height });
    if (!this.#error) return;
    const image = new ImageData(width, height);
    const words = new Uint32Array(image.data.buffer);
    this.#error.forEach((difference, pixel) => (words[pixel] = HEAT[difference]));
    canvas.getContext('2d').putImageData(image, 0, 0);
  }

  #place() {
    const { x, y, zoom } = this.view;
    const width = this.#panes[0].root.clientWidth;
    const [edge] = this.view.toPicture([THUMB / 2 + this.#wipe * (width - THUMB), 0]);
    this.#root.style.setProperty('--wipe', `${Math.max(0, Math.min(this.#picture?.width ?? 0, edge))}px`);
    for (const pane of this.#panes) {
      pane.sheet.style.transform = `translate(${x}px, ${y}px) scale(${zoom})`;
      pane.sheet.style.setProperty('--pixel', `${1 / zoom}px`);
      pane.sheet.classList.toggle('coarse', zoom >= 3);
    }
    const bounds = this.#selected === null ? null : this.#boundsOf(this.#selected);
    this.#panes.forEach((pane) => this.#handles.place(pane.handles, bounds, this.view));
  }

  #boundsOf(k) {
    const measure = this.#drawn?.measures[k];
    if (measure?.bounds_x_px === undefined) return null;
    const { bounds_x_px: x, bounds_y_px: y, bounds_width_px: width, bounds_height_px: height } = measure;
    return { x, y, width, height };
  }

  #mark() {
    for (const pane of this.#panes) {
      for (const element of pane.touch.querySelectorAll('[data-object]')) {
        const k = Number(element.dataset.object);
        element.classList.toggle('hovered', k === this.#hovered);
        element.classList.toggle('selected', k === this.#selected);
      }
    }
  }

  // A pointer that is held belongs to the pane where it came down, wherever it goes.
  #at(event) {
    const held = this.#pointers.get(event.pointerId)?.pane;
    const pane = held ?? event.target.closest?.('.pane') ?? this.#panes[0].root;
    const box = pane.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  #objectAt(event) {
    const element = event.target.closest?.('[data-object]');
    return element ? Number(element.dataset.object) : null;
  }

  #wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    this.view.zoomBy(Math.exp((-event.deltaY * lines) / 400), this.#at(event));
  }

  #down(event) {
    if (event.button > 1 || !this.#picture) return;
    const from = this.#at(event);
    this.#pointers.set(event.pointerId, { pane: event.target.closest?.('.pane') ?? this.#panes[0].root, at: from });
    if (this.#pointers.size === 2) {
      this.#drag = { kind: 'pinch', ...pinch([...this.#pointers.values()]) };
      return;
    }
    const handle = event.target.closest?.('[data-handle]')?.dataset.handle;
    const k = this.#objectAt(event);
    const at = this.view.toPicture(from);
    if (handle && this.#selected !== null) this.#drag = { kind: handle, k: this.#selected, from: at, ...this.#center() };
    else if (k !== null && event.button === 0) {
      this.#tell('select', k);
      this.#drag = { kind: 'move', k, from: at };
    } else {
      if (event.button === 0) this.#tell('select', null);
      this.#drag = { kind: 'pan', last: from };
    }
    if (event.target.isConnected) this.#root.setPointerCapture(event.pointerId);
  }

  #center() {
    const { x, y, width, height } = this.#boundsOf(this.#selected) ?? { x: 0, y: 0, width: 0, height: 0 };
    return { center: [x + width / 2, y + height / 2] };
  }

  #move(event) {
    if (!this.#pointers.has(event.pointerId)) {
      if (event.pointerType !== 'touch') this.#tell('hover', this.#objectAt(event));
      return;
    }
    const now = this.#at(event);
    this.#pointers.get(event.pointerId).at = now;
    const drag = this.#drag;
    if (drag?.kind === 'pan') {
      this.view.panBy(now[0] - drag.last[0], now[1] - drag.last[1]);
      drag.last = now;
    } else if (drag?.kind === 'pinch') {
      const { middle, apart } = pinch([...this.#pointers.values()]);
      this.view.panBy(middle[0] - drag.middle[0], middle[1] - drag.middle[1]);
      this.view.zoomBy(apart / drag.apart, middle);
      Object.assign(drag, { middle, apart });
    } else if (drag) {
      const at = this.view.toPicture(now);
      if (drag.moved || Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) * this.view.zoom > 3) {
        drag.moved = true;
        this.#tell('gesture', { ...drag, at });
      }
    }
  }

  #up(event) {
    this.#pointers.delete(event.pointerId);
    if (this.#drag?.moved) this.#tell('settle', null);
    this.#drag = null;
  }
}

/** A copy of a drawing whose objects say which they are: `data-object`, from 0. Without `isWhole` only their outlines. */
function named(root, isWhole) {
  const copy = document.importNode(root, true);
  copy.setAttribute('aria-hidden', 'true');
  for (const element of copy.querySelectorAll('[id^="object-"]')) {
    element.dataset.object = String(Number(element.id.slice('object-'.length)) - 1);
  }
  if (!isWhole) {
    // Neither blur, nor masks, nor what is drawn once more where objects mix.
    copy.querySelectorAll('filter, mask, #background, g[mask], style').forEach((element) => element.remove());
    copy.querySelectorAll('[filter]').forEach((element) => element.removeAttribute('filter'));
    copy.querySelectorAll('[id]').forEach((element) => element.removeAttribute('id'));
  }
  return copy;
}

function pinch([{ at: [ax, ay] }, { at: [bx, by] }]) {
  return { middle: [(ax + bx) / 2, (ay + by) / 2], apart: Math.max(1, Math.hypot(ax - bx, ay - by)) };
}

/** Colors of differences 0 to 255, as ImageData has them: black, violet, orange, white; roots, since small ones matter. */
const HEAT = Uint32Array.from({ length: 256 }, (_, difference) => {
  const stops = [[12, 10, 24], [88, 28, 120], [232, 96, 60], [255, 236, 190]];
  const at = Math.sqrt(difference / 255) * (stops.length - 1);
  const [low, share] = [Math.min(stops.length - 2, Math.floor(at)), at - Math.min(stops.length - 2, Math.floor(at))];
  const [red, green, blue] = [0, 1, 2].map((c) => Math.round(stops[low][c] + share * (stops[low + 1][c] - stops[low][c])));
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
});
