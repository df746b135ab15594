// The list of objects, front ones first, and the inspector of the selected one.
import { doubtsOf } from './doubts.js';

const KINDS = {
  circle: 'Circle',
  ellipse: 'Ellipse',
  rectangle: 'Rectangle',
  regular_polygon: 'Regular polygon',
  star: 'Star',
  polygon: 'Polygon',
  path: 'Path',
  stroke: 'Stroke',
  efd: 'Free shape',
  prototype: 'Known shape',
};

const made = (tag, properties = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
};

/** A length in pixels with as many digits as it deserves, and its standard deviation if that is known. */
const length = (value, deviation) => {
  if (value === undefined) return '–';
  // No minus before what rounds to nothing.
  const text = (Math.abs(value) < 0.005 ? 0 : value).toFixed(Math.abs(value) < 100 ? 2 : 1);
  return deviation === undefined ? text : `${text} ± ${deviation < 0.01 ? deviation.toFixed(4) : deviation.toFixed(2)}`;
};

export const hexOf = (color) =>
  `#${color.map((value) => Math.round(255 * Math.min(1, Math.max(0, value))).toString(16).padStart(2, '0')).join('')}`;

export const kindOf = (object, measure) => {
  if (object.kind === 'regular_polygon') return `Polygon of ${object.sides} equal sides`;
  if (object.kind === 'star') return `Star of ${object.points} points`;
  return measure?.prototype ? `Known shape: ${measure.prototype}` : (KINDS[object.kind] ?? object.kind);
};

export class ObjectList {
  #root;
  #actions;

  /** `actions`: select, hover, recolor, reorder, remove; each takes the number of an object, from 0. */
  constructor(root, actions) {
    this.#root = root;
    this.#actions = actions;
    root.addEventListener('keydown', (event) => this.#key(event));
    root.addEventListener('pointerleave', () => actions.hover(null));
  }

  /** Shows objects with their measures. */
  show(objects, measures, selected) {
    const focused = this.#root.contains(document.activeElement) && document.activeElement.getAttribute('role') === 'option';
    const items = objects.map((object, k) => this.#item(object, measures[k] ?? {}, k, k === selected));
    this.#root.replaceChildren(...items.reverse());
    const current = this.#root.querySelector('[aria-selected="true"]') ?? this.#root.firstElementChild;
    if (current) current.tabIndex = 0;
    if (focused) current?.focus({ preventScroll: true });
  }

  /** Marks the selected one, and brings it into view. */
  mark(selected, hovered) {
    for (const item of this.#root.children) {
      const k = Number(item.dataset.object);
      item.setAttribute('aria-selected', String(k === selected));
      item.tabIndex = k === selected ? 0 : -1;
      item.classList.toggle('hovered', k === hovered);
      if (k === selected) item.scrollIntoView({ block: 'nearest' });
    }
    if (selected === null && this.#root.firstElementChild) this.#root.firstElementChild.tabIndex = 0;
  }

  #item(object, measure, k, isSelected) {
    const swatch = made('span', { className: 'swatch' });
    swatch.style.background = hexOf(object.color);
    const place = `at ${length(measure.centroid_x_px)}, ${length(measure.centroid_y_px)}`;
    const size = `${length(measure.bounds_width_px)} × ${length(measure.bounds_height_px)} px`;
    const doubts = doubtsOf(object);
    const text = made('span', { className: 'text' }, made('strong', { textContent: kindOf(object, measure) }), made('small', { textContent: `${size} ${place}` }));
    const item = made('li', { className: 'object', tabIndex: -1 }, made('span', { className: 'number', textContent: k + 1 }), swatch, text);
    if (doubts.length) item.append(made('span', { className: 'doubt', title: doubts.join('\n'), textContent: '?' }));
    item.dataset.object = k;
    item.setAttribute('role', 'option');
    item.setAttribute('aria-selected', String(isSelected));
    item.setAttribute('aria-label', `${k + 1}: ${kindOf(object, measure)}, ${hexOf(object.color)}, ${size} ${place}${doubts.length ? `; ${doubts.join('; ')}` : ''}`);
    item.addEventListener('click', () => this.#actions.select(k));
    item.addEventListener('pointerenter', () => this.#actions.hover(k));
    return item;
  }

  #key(event) {
    const item = event.target.closest('[role="option"]');
    const next = { ArrowDown: item?.nextElementSibling, ArrowUp: item?.previousElementSibling }[event.key];
    if (event.altKey || event.ctrlKey || event.metaKey || !(event.key in { ArrowDown: 1, ArrowUp: 1 })) return;
    event.preventDefault();
    event.stopPropagation();
    if (next) {
      this.#actions.select(Number(next.dataset.object));
      this.#root.querySelector('[aria-selected="true"]')?.focus();
    }
  }
}

/** The numbers of one object, and what can be done to it. */
export class Inspector {
  #root;
  #actions;

  constructor(root, actions) {
    this.#root = root;
    this.#actions = actions;
  }

  show(object, measure, k) {
    this.#root.hidden = !object;
    if (!object) return;
    const color = made('input', { type: 'color', value: hexOf(object.color) });
    color.setAttribute('aria-label', 'Color');
    color.addEventListener('change', () => this.#actions.recolor(k, color.value));
    const { reorder, remove, turn, scale } = this.#actions;
    const buttons = [
      ['↑', 'Paint it later ( ] )', () => reorder(k, k + 1)],
      ['↓', 'Paint it earlier ( [ )', () => reorder(k, k - 1)],
      ['↺', 'Turn by 5° to the left ( , )', () => turn(-5)],
      ['↻', 'Turn by 5° to the right ( . )', () => turn(5)],
      ['−', 'Smaller', () => scale(1 / 1.05)],
      ['+', 'Larger', () => scale(1.05)],
      ['Delete', 'Delete (Del)', () => remove(k)],
    ].map(([text, title, action]) => {
      const button = made('button', { type: 'button', textContent: text, title });
      button.setAttribute('aria-label', title);
      button.addEventListener('click', action);
      return button;
    });
    const rows = [
      ['Center', `${length(measure.centroid_x_px, measure.centroid_x_sd_px)}, ${length(measure.centroid_y_px, measure.centroid_y_sd_px)} px`],
      ['Area', `${length(measure.area_px2, measure.area_sd_px2)} px²`],
      ['Outline', `${length(measure.perimeter_px, measure.perimeter_sd_px)} px`],
      ['Axes', `${length(measure.major_axis_px, measure.major_axis_sd_px)} × ${length(measure.minor_axis_px, measure.minor_axis_sd_px)} px`],
      ['Angle', measure.angle_deg === undefined ? 'none: it has no direction' : `${length(measure.angle_deg, measure.angle_sd_deg)}°`],
      ['Seen', `${(100 * (measure.visible ?? 0)).toFixed(0)} %`],
    ];
    if ((measure.confidence ?? 1) < 1) rows.push(['Opacity', `${(100 * measure.confidence).toFixed(0)} %`]);
    const numbers = made('dl', {}, ...rows.flatMap(([name, value]) => [made('dt', { textContent: name }), made('dd', { textContent: value })]));
    const doubts = doubtsOf(object).map((line) => made('p', { className: 'doubts', textContent: line }));
    this.#root.replaceChildren(
      made('header', {}, made('h3', { textContent: `${k + 1} · ${kindOf(object, measure)}` }), color),
      numbers,
      ...doubts,
      made('div', { className: 'buttons' }, ...buttons),
    );
  }
}
