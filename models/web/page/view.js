// Where the picture stands in a pane: zoom and pan, shared by all panes.

const MOST_ZOOM = 64;

export class View {
  zoom = 1;
  x = 0;
  y = 0;
  #size = [1, 1];
  #pane = [1, 1];
  #fitted = true;
  #changed;

  /** `changed` is called whenever something moved. */
  constructor(changed) {
    this.#changed = changed;
  }

  /** A picture of this size, in pixels. */
  show(width, height) {
    this.#size = [width, height];
    this.fit();
  }

  /** Panes of this size, in CSS pixels. */
  resize(width, height) {
    this.#pane = [width, height];
    if (this.#fitted) this.fit();
    else this.#changed();
  }

  /** The whole picture, with a margin; small ones are enlarged. */
  fit() {
    const [width, height] = this.#size;
    const [paneWidth, paneHeight] = this.#pane;
    const margin = Math.min(48, 0.08 * Math.min(paneWidth, paneHeight));
    this.zoom = Math.max(0.01, Math.min(16, (paneWidth - 2 * margin) / width, (paneHeight - 2 * margin) / height));
    this.x = (paneWidth - this.zoom * width) / 2;
    this.y = (paneHeight - this.zoom * height) / 2;
    this.#fitted = true;
    this.#changed();
  }

  /** `factor` times as large around a point of the pane; around its center if none is given. */
  zoomBy(factor, [x, y] = this.#pane.map((side) => side / 2)) {
    const zoom = Math.max(0.02, Math.min(MOST_ZOOM, this.zoom * factor));
    const ratio = zoom / this.zoom;
    [this.x, this.y, this.zoom] = [x - ratio * (x - this.x), y - ratio * (y - this.y), zoom];
    this.#fitted = false;
    this.#changed();
  }

  panBy(dx, dy) {
    this.x += dx;
    this.y += dy;
    this.#fitted = false;
    this.#changed();
  }

  /** A point of the pane in pixels of the picture. */
  toPicture([x, y]) {
    return [(x - this.x) / this.zoom, (y - this.y) / this.zoom];
  }

  /** A point of the picture in the pane. */
  toPane([x, y]) {
    return [this.x + this.zoom * x, this.y + this.zoom * y];
  }
}
