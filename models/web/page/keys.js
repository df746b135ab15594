// The keyboard.

/** A listener for keys; `actions` are those of the page. */
export function keys(actions) {
  const { selected } = actions;
  const onSelected = (run) => () => selected() !== null && run(selected());
  const plain = {
    Escape: actions.cancel,
    '+': () => actions.zoom.zoomBy(1.25),
    '=': () => actions.zoom.zoomBy(1.25),
    '-': () => actions.zoom.zoomBy(0.8),
    0: () => actions.zoom.fit(),
    o: actions.open,
    f: actions.refine,
    ']': onSelected((k) => actions.reorder(k, k + 1)),
    '[': onSelected((k) => actions.reorder(k, k - 1)),
    ',': () => actions.turn(-5),
    '.': () => actions.turn(5),
    '<': () => actions.scale(1 / 1.05),
    '>': () => actions.scale(1.05),
    Delete: onSelected(actions.remove),
    Backspace: onSelected(actions.remove),
  };
  ['beside', 'wipe', 'outlines', 'result', 'error'].forEach((mode, at) => (plain[at + 1] = () => actions.setMode(mode)));
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  return (event) => {
    // Fields keep their keys.
    if (event.target.closest?.('input, select, textarea')) return;
    const { key } = event;
    if (event.ctrlKey || event.metaKey) {
      const run = { z: event.shiftKey ? actions.redo : actions.undo, Z: actions.redo, y: actions.redo }[key];
      if (run) {
        event.preventDefault();
        run();
      }
      return;
    }
    if (event.altKey) return;
    const arrow = arrows[key];
    if (arrow && selected() !== null && !event.target.closest?.('[role="radio"]')) {
      event.preventDefault();
      const step = event.shiftKey ? 10 : 1;
      actions.nudge(arrow[0] * step, arrow[1] * step);
    } else if (arrow && event.target.closest?.('[role="radio"]')) {
      const next = event.target[arrow[0] + arrow[1] > 0 ? 'nextElementSibling' : 'previousElementSibling'];
      next?.click();
      next?.focus();
    } else if (plain[key] && !(key === 'Escape' && event.defaultPrevented)) {
      event.preventDefault();
      plain[key]();
    }
  };
}
