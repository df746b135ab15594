// The box around the selected object, with corners to scale it and a knob to turn it.

const SVG = 'http://www.w3.org/2000/svg';

const element = (tag, attributes) => {
  const made = document.createElementNS(SVG, tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  return made;
};

export class Handles {
  /** Draws them into an SVG that covers a pane; none without bounds (pixels of the picture). */
  place(svg, bounds, view) {
    if (!bounds) {
      svg.replaceChildren();
      return;
    }
    const [left, top] = view.toPane([bounds.x, bounds.y]);
    const [right, bottom] = view.toPane([bounds.x + bounds.width, bounds.y + bounds.height]);
    const middle = (left + right) / 2;
    const knob = top > 36 ? top - 24 : bottom + 24;
    const corners = [[left, top], [right, top], [left, bottom], [right, bottom]];
    svg.replaceChildren(
      element('rect', { class: 'frame', x: left, y: top, width: right - left, height: bottom - top }),
      element('line', { class: 'frame', x1: middle, x2: middle, y1: knob < top ? top : bottom, y2: knob }),
      ...corners.flatMap(([x, y], at) => grip('scale', x, y, at === 0 || at === 3 ? 'nwse' : 'nesw')),
      ...grip('turn', middle, knob, 'turn'),
    );
  }
}

/** A dot to be seen and a larger one to be touched. */
function grip(handle, x, y, cursor) {
  const touch = element('circle', { class: `reach ${cursor}`, cx: x, cy: y, r: 14, 'data-handle': handle });
  return [element('circle', { class: 'grip', cx: x, cy: y, r: 5 }), touch];
}
