// The page: what comes in goes to the engine, what comes out to the stage and the list.
import { DecodeError, decode, reduced } from './decode.js';
import { verdict } from './doubts.js';
import * as edit from './edit.js';
import { Canceled, Engine, Latest } from './engine.js';
import { download, stemOf, toPng } from './export.js';
import { keys } from './keys.js';
import { Inspector, ObjectList } from './list.js';
import { LossCurve, Player } from './refine.js';
import { showSamples } from './samples.js';
import { Stage } from './stage.js';

const byId = (id) => document.getElementById(id);
/** Choices of the slider for the most objects. */
const MOST_OBJECTS = [1, 2, 4, 8, 16, 32, 64, 128, 256];
/** Fits that take longer say so, ms. */
const PATIENCE_MS = 150;

// One fits and refines, one draws: what is shown keeps up with what is computed.
const fitter = new Engine();
const painter = new Engine();
const stage = new Stage(byId('stage'));
const history = new edit.History();
const curve = new LossCurve(byId('curve'));
const page = { picture: null, bank: '', fit: null, selected: null, hovered: null, measures: [], preview: null, work: null, turn: 0 };

const drawing = new Latest(async (state) => {
  const { picture } = page;
  const { scene } = state;
  try {
    const { svg, measures } = await painter.call('draw', { scene, bank: page.bank, covariance: edit.flatCovariance(state) });
    if (page.picture !== picture) return;
    page.measures = measures;
    stage.draw(svg, measures);
    showList(state);
    // The objects are there; how far they are from the picture follows.
    page.fit.total ??= performance.now() - page.fit.start;
    const { mae, differences } = await painter.call('compare', { scene, bank: page.bank });
    if (page.picture !== picture) return;
    stage.showError(differences);
    showFigures(scene, mae);
  } catch (error) {
    if (!(error instanceof Canceled)) tell(error.message);
  }
});

const current = () => page.preview ?? history.current;

/** Shows a state: a draft while a hand moves something, else the newest one. */
function show(state) {
  page.preview = state === history.current ? null : state;
  byId('undo').disabled = !history.canUndo;
  byId('redo').disabled = !history.canRedo;
  return drawing.ask(state);
}

function change(state) {
  // What is being fitted will be another state soon.
  if (page.work) return Promise.resolve();
  history.push(state);
  const last = state.scene.objects.length - 1;
  if (page.selected !== null && page.selected > last) select(last >= 0 ? last : null);
  return show(state);
}

function select(k) {
  page.selected = k;
  stage.selected = k;
  list.mark(k, page.hovered);
  showInspector();
}

function hover(k) {
  if (k === page.hovered) return;
  page.hovered = k;
  stage.hovered = k;
  list.mark(page.selected, k);
}

const actions = {
  select,
  hover,
  recolor: (k, hex) => change(edit.recolored(current(), k, hex)),
  remove(k) {
    select(null);
    change(edit.deleted(current(), k));
  },
  reorder(k, to) {
    if (to < 0 || to >= current().scene.objects.length) return;
    page.selected = to;
    change(edit.reordered(current(), k, to)).then(() => select(to));
  },
  turn: (degrees) => changeSelected((state, k) => edit.turned(state, k, (degrees * Math.PI) / 180, centerOf(k))),
  scale: (factor) => changeSelected((state, k) => edit.scaled(state, k, factor, centerOf(k))),
  nudge: (dx, dy) => changeSelected((state, k) => edit.moved(state, k, [dx / unit(), dy / unit()])),
};

function changeSelected(how) {
  if (page.selected !== null && current() && !page.work) change(how(current(), page.selected));
}

/** Pixels of a scene unit: the shorter side. */
const unit = () => Math.min(page.picture.width, page.picture.height);
const toScene = (point) => point.map((at) => at / unit());

function centerOf(k) {
  const { bounds_x_px: x = 0, bounds_y_px: y = 0, bounds_width_px: width = 0, bounds_height_px: height = 0 } = page.measures[k] ?? {};
  return toScene([x + width / 2, y + height / 2]);
}

const list = new ObjectList(byId('list'), actions);
const inspector = new Inspector(byId('inspector'), actions);

function showList({ scene }) {
  list.show(scene.objects, page.measures, page.selected);
  showInspector();
}

function showInspector() {
  const object = page.selected === null ? null : current()?.scene.objects[page.selected];
  inspector.show(object, page.measures[page.selected] ?? {}, page.selected);
}

function showFigures(scene, mae) {
  const parts = [`Mean error ${(255 * mae).toFixed(2)} of 255`];
  if (scene === page.fit.scene) parts.push(`found in ${page.fit.ms.toFixed(0)} ms`);
  else parts.push(`edited: ${scene.objects.length} of ${page.fit.scene.objects.length} objects`);
  byId('figures').textContent = parts.join(' · ');
}

function showVerdict(scene) {
  const { level, title, lines } = verdict(scene);
  const box = byId('verdict');
  box.dataset.level = level;
  box.querySelector('.title').textContent = title;
  box.querySelector('.lines').replaceChildren(...lines.map((line) => Object.assign(document.createElement('p'), { textContent: line })));
}

// What runs for long, and how it is ended.

/** Shows that something runs if it takes long; `cancel` ends it. */
async function working(text, cancel, run) {
  const start = performance.now();
  const work = (page.work = { cancel });
  document.body.dataset.busy = 'true';
  const tick = () => {
    const elapsed = performance.now() - start;
    if (elapsed < PATIENCE_MS) return;
    byId('progress').hidden = false;
    byId('progress-text').textContent = `${text} ${(elapsed / 1000).toFixed(elapsed < 10_000 ? 1 : 0)} s`;
  };
  const timer = setInterval(tick, 100);
  try {
    return await run();
  } finally {
    clearInterval(timer);
    if (page.work === work) {
      page.work = null;
      delete document.body.dataset.busy;
      byId('progress').hidden = true;
    }
  }
}

function tell(text, action = null) {
  byId('message-text').textContent = text;
  byId('message').hidden = false;
  const button = byId('message-action');
  button.hidden = !action;
  if (action) Object.assign(button, { textContent: action.text, onclick: action.run });
}

const hush = () => (byId('message').hidden = true);

/** Opens a file: decodes it and finds its objects. */
async function open(file) {
  page.turn += 1;
  page.work?.cancel();
  hush();
  const start = performance.now();
  let picture = null;
  try {
    picture = await decode(file);
  } catch (error) {
    if (!(error instanceof DecodeError) || !error.bitmap) return tell(error.message);
    const run = async () => take(await reduced(error.bitmap), performance.now());
    return tell(error.message, { text: 'Fit a smaller copy', run });
  }
  return take(picture, start);
}

async function take(picture, start) {
  hush();
  page.work?.cancel();
  page.picture = picture;
  page.preview = null;
  const { rgba, width, height, coded } = picture;
  document.body.dataset.state = 'picture';
  byId('welcome').hidden = true;
  stage.show(picture.bitmap);
  try {
    await Promise.all([fitter, painter].map((engine) => engine.load({ rgba, width, height, coded })));
    await fit(start);
  } catch (error) {
    if (!(error instanceof Canceled)) tell(error.message);
  }
}

/** Finds the objects of the picture. */
async function fit(start = performance.now()) {
  const { picture } = page;
  if (!picture) return;
  const turn = ++page.turn;
  hush();
  const bank = byId('bank').value;
  const maxObjects = MOST_OBJECTS[byId('most').value];
  const megapixels = (picture.width * picture.height) / 1e6;
  const size = megapixels < 0.1 ? '' : ` in ${megapixels.toFixed(1)} million pixels`;
  try {
    const fitted = await working(`Looking for objects${size}…`, () => fitter.cancel(), () => fitter.call('fit', { maxObjects, bank }));
    if (turn !== page.turn) return;
    page.bank = bank;
    page.fit = { ...fitted, start };
    const covariance = fitted.scene.objects.map((_, k) => fitted.covariance[k] ?? null);
    history.reset({ scene: fitted.scene, covariance });
    curve.reset();
    select(null);
    document.body.dataset.state = 'found';
    showVerdict(fitted.scene);
    await show(history.current);
    document.body.dataset.found = JSON.stringify({ name: picture.name, ms: page.fit.ms, total: page.fit.total });
  } catch (error) {
    // Another picture or other settings took over.
    if (turn !== page.turn) return;
    if (error instanceof Canceled) tell('Canceled. Nothing was found yet; the picture is still here.', { text: 'Try again', run: () => (hush(), fit()) });
    else tell(error.message);
  }
}

/** Moves the drawing to where it explains the picture best, step by step. */
async function refine() {
  const state = current();
  if (!state || page.work) return;
  const { known, ...scene } = state.scene;
  curve.reset();
  let begun = false;
  const player = new Player(async (steps) => {
    steps.forEach(({ loss }) => curve.add(loss));
    await show({ scene: steps.at(-1).scene, covariance: steps.at(-1).scene.objects.map(() => null) });
  });
  const heard = (step) => player.push(step);
  try {
    const cancel = () => (player.stop(), fitter.cancel());
    const refined = await working('Fitting…', cancel, async () => {
      begun = true;
      const shown = player.play();
      const value = await fitter.call('refine', { scene, bank: page.bank, maxSteps: 400 }, heard);
      player.end();
      await shown;
      return value;
    });
    // What the fit said of the scene as a whole it said of other numbers.
    await change({ scene: refined.scene, covariance: refined.scene.objects.map(() => null) });
  } catch (error) {
    player.stop();
    if (begun) await show(history.current);
    if (!(error instanceof Canceled)) tell(error.message);
  }
}

async function exported(kind) {
  const state = current();
  if (!state) return;
  const { scene } = state;
  const { picture, bank } = page;
  const stem = stemOf(picture.name);
  try {
    if (kind === 'json') return download(`${JSON.stringify(scene)}\n`, `${stem}.json`, 'application/json');
    const covariance = edit.flatCovariance(state);
    if (kind === 'svg') return download((await painter.call('draw', { scene, bank, covariance })).svg, `${stem}.svg`, 'image/svg+xml');
    if (kind === 'csv') return download(await painter.call('table', { scene, bank, covariance, name: picture.name }), `${stem}.csv`, 'text/csv');
    const { width, height } = picture;
    download(await toPng(await painter.call('paint', { scene, bank, width, height })), `${stem}.png`, 'image/png');
  } catch (error) {
    tell(error.message);
  }
}

// Hands.

stage.on('hover', hover);
stage.on('select', (k) => select(page.work ? null : k));
let grabbed = null;
stage.on('gesture', ({ kind, k, from, at, center }) => {
  if (page.work) return;
  grabbed ??= history.current;
  const [[x0, y0], [x1, y1]] = [from, at];
  if (kind === 'move') show(edit.moved(grabbed, k, toScene([x1 - x0, y1 - y0])));
  else {
    const [cx, cy] = center;
    const ratio = Math.hypot(x1 - cx, y1 - cy) / Math.max(1e-6, Math.hypot(x0 - cx, y0 - cy));
    const angle = Math.atan2(y1 - cy, x1 - cx) - Math.atan2(y0 - cy, x0 - cx);
    show(kind === 'scale' ? edit.scaled(grabbed, k, Math.max(0.02, ratio), toScene(center)) : edit.turned(grabbed, k, angle, toScene(center)));
  }
});
stage.on('settle', () => {
  if (grabbed && page.preview) change(page.preview);
  grabbed = null;
});

function setMode(mode) {
  stage.mode = mode;
  for (const button of document.querySelectorAll('[data-mode][role="radio"]')) {
    button.setAttribute('aria-checked', String(button.dataset.mode === mode));
    button.tabIndex = button.dataset.mode === mode ? 0 : -1;
  }
  byId('wipe').hidden = mode !== 'wipe';
}

const undo = () => (page.work ? null : (history.canUndo && (history.undo(), again())));
const redo = () => (page.work ? null : (history.canRedo && (history.redo(), again())));
function again() {
  if (page.selected !== null && page.selected >= history.current.scene.objects.length) select(null);
  show(history.current);
}

for (const button of document.querySelectorAll('[data-mode][role="radio"]')) button.addEventListener('click', () => setMode(button.dataset.mode));
for (const button of document.querySelectorAll('[data-export]')) button.addEventListener('click', () => exported(button.dataset.export));
const clicks = {
  undo, redo, refine,
  open: () => byId('file').click(),
  choose: () => byId('file').click(),
  cancel: () => page.work?.cancel(),
  'message-close': hush,
  'zoom-in': () => stage.view.zoomBy(1.5),
  'zoom-out': () => stage.view.zoomBy(1 / 1.5),
  'zoom-fit': () => stage.view.fit(),
  shake: () => current() && !page.work && change(edit.shaken(current(), Math.random)),
};
for (const [id, run] of Object.entries(clicks)) byId(id).addEventListener('click', () => run());
byId('wipe').addEventListener('input', ({ target }) => (stage.wipe = target.value / 1000));
byId('most').addEventListener('input', ({ target }) => (byId('most-value').textContent = MOST_OBJECTS[target.value]));
for (const id of ['most', 'bank']) byId(id).addEventListener('change', () => page.picture && (page.work?.cancel(), fit()));
byId('file').addEventListener('change', ({ target }) => {
  if (target.files[0]) open(target.files[0]);
  target.value = '';
});

addEventListener('dragover', (event) => {
  event.preventDefault();
  byId('veil').hidden = false;
});
addEventListener('dragleave', (event) => event.relatedTarget === null && (byId('veil').hidden = true));
addEventListener('drop', (event) => {
  event.preventDefault();
  byId('veil').hidden = true;
  const [file] = event.dataTransfer?.files ?? [];
  if (file) open(file);
  else tell('That was no file. Drop a picture from a folder, or copy and paste it.');
});
addEventListener('paste', (event) => {
  const [file] = event.clipboardData?.files ?? [];
  if (file) open(file);
});
addEventListener('keydown', keys({
  ...actions, undo, redo, refine, setMode,
  open: clicks.open,
  zoom: stage.view,
  selected: () => page.selected,
  cancel: () => (page.work ? page.work.cancel() : byId('message').hidden ? select(null) : hush()),
}));

setMode('beside');
stage.wipe = 0.5;
showSamples(byId('samples'), open);
fitter.call('warm').catch((error) => tell(`The fit could not be started: ${error.message}`));
