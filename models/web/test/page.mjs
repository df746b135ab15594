// The page in a real browser: `node page.mjs DIST PICTURES DVP RESVG [SCREENSHOTS]`.
//
// PICTURES is a folder with pictures to drop, `icon.png` of 256 pixels among them; DVP the command; RESVG the example of dvp-wasm that draws
// an SVG with resvg. What is exported, and what the command found, lies in PICTURES afterwards.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { PNG } from 'pngjs';
import { drop, found, open } from './browser.mjs';

const [dist, pictures, dvp, resvg, shots] = process.argv.slice(2);
if (!resvg) throw new Error('usage: node page.mjs DIST PICTURES DVP RESVG [SCREENSHOTS]');
const exported = join(pictures, 'exported');
mkdirSync(exported, { recursive: true });
const typeOf = (name) => ({ png: 'image/png', jpg: 'image/jpeg', webp: 'image/webp' })[name.split('.').pop()];
const read = (name) => readFileSync(join(pictures, name));

const { page, problems, close } = await open(dist);
const checks = [];
const check = (name, run) => checks.push({ name, run });
const settled = () => page.waitForFunction(() => !document.body.dataset.busy);
const objects = () => page.locator('#list [role="option"]').count();

// The list is drawn anew with the next frame, which a busy machine may take long for.
const until = async (wanted, told) => {
  for (let k = 0; k < 200 && (await objects()) !== wanted; k++) await page.waitForTimeout(50);
  assert.equal(await objects(), wanted, told);
};
const message = async (timeout = 20_000) => {
  await page.waitForSelector('#message:not([hidden])', { timeout });
  return page.textContent('#message-text');
};

/** The text or the bytes of an export, by a click on its button. */
async function download(kind) {
  const [file] = await Promise.all([page.waitForEvent('download'), page.click(`[data-export="${kind}"]`)]);
  return readFileSync(await file.path());
}

const scene = async () => JSON.parse(await download('json'));
const shot = async (name) => shots && (await page.screenshot({ path: join(shots, `${name}.png`) }));

/** The command's scene of a picture. */
function native(name) {
  execFileSync(dvp, ['fit', join(pictures, name), '--out', join(pictures, 'native'), '--no-png'], { stdio: 'ignore' });
  return JSON.parse(readFileSync(join(pictures, 'native', name.replace(/\.[^.]*$/, '.json')), 'utf8'));
}

/** The largest difference of numbers of two JSON values of the same structure; throws where structures differ. */
function farthest(a, b, path = '') {
  if (typeof a === 'number' && typeof b === 'number') return Math.abs(a - b);
  if (typeof a !== 'object' || a === null || b === null) {
    assert.equal(a, b, path);
    return 0;
  }
  assert.deepEqual(Object.keys(a), Object.keys(b), path);
  return Object.keys(a).reduce((most, key) => Math.max(most, farthest(a[key], b[key], `${path}.${key}`)), 0);
}

/** The pixels of an exported SVG, as resvg draws it. */
function drawnByResvg(stem) {
  execFileSync(resvg, [join(exported, `${stem}.svg`), join(exported, `${stem}.rgba`)]);
  return readFileSync(join(exported, `${stem}.rgba`));
}

/** resvg places edges to a quarter of a pixel, the page by the area that is covered: an edge may differ by an eighth of full contrast and more
 * where two edges cross a pixel. */
const EDGE = 48;

/** How far two images over white are apart, in steps of 1/255: on average, at most, and the share of pixels off by more than an edge. */
function difference(a, b) {
  assert.equal(a.length, b.length);
  const over = (pixels, at, channel) => 255 + (pixels[at + channel] - 255) * (pixels[at + 3] / 255);
  let [sum, most, far] = [0, 0, 0];
  for (let at = 0; at < a.length; at += 4) {
    const apart = [0, 1, 2].map((channel) => Math.abs(over(a, at, channel) - over(b, at, channel)));
    sum += apart[0] + apart[1] + apart[2];
    const own = Math.max(...apart);
    most = Math.max(most, own);
    if (own > EDGE) far += 1;
  }
  return { mean: sum / ((3 * a.length) / 4), most: Math.round(most), share: far / (a.length / 4) };
}

const bare = ({ objects: all, background }) => ({ background, objects: all.map(({ known, ...object }) => object) });

check('ten pictures of several kinds: dropped, found, exported', async () => {
  const files = readdirSync(pictures).filter((name) => typeOf(name));
  assert.ok(files.length >= 10, `${files.length} pictures`);
  for (const name of files) {
    await drop(page, read(name), name, typeOf(name));
    const { ms, total } = await found(page);
    const own = await scene();
    assert.equal(await objects(), own.objects.length, name);
    const [svg, png, csv] = [await download('svg'), await download('png'), (await download('csv')).toString()];
    const stem = name.replace(/\.[^.]*$/, '');
    for (const [ending, bytes] of Object.entries({ svg, png, csv, json: JSON.stringify(own) })) writeFileSync(join(exported, `${stem}.${ending}`), bytes);
    const painted = PNG.sync.read(png);
    assert.deepEqual([painted.width, painted.height], [own.width, own.height], name);
    const drawn = difference(painted.data, drawnByResvg(stem));
    assert.ok(drawn.mean < 0.5 && drawn.share < 0.001, `${name}: resvg draws another picture: ${JSON.stringify(drawn)}`);
    assert.equal(csv.trim().split('\n').length, Math.max(1, own.objects.length + 1), 'a row per object');
    const theirs = native(name);
    // Decoders of JPEG differ by a step or two, and so do what is read off them; else numbers differ as instructions do.
    const isCoded = typeOf(name) === 'image/jpeg';
    const counts = [own, theirs].map((found) => found.objects.length);
    if (!isCoded) assert.equal(...counts, `${name}: as many objects as the command finds`);
    let far = 'coded, not compared';
    if (!isCoded) {
      far = farthest(bare(own), bare(theirs), name);
      assert.ok(far < 2e-3, `${name}: numbers are off by ${far}`);
      far = `off by ${far.toExponential(1)} scene units`;
    }
    const vector = `resvg ${drawn.mean.toFixed(3)} of 255 on average, ${drawn.most} at most`;
    console.log(`    ${name}: ${counts.join(' and ')} objects (page, command), ${far}; ${vector}; ${ms.toFixed(0)} ms, ${total.toFixed(0)} ms from the drop`);
  }
});

// Figures, not a verdict: what else the machine does would decide it. With DVP_TIMES=1, on an idle one, at most 2.5 times as long.
check('how long a 256 px icon takes, beside the command', async () => {
  const name = 'icon.png';
  const times = { page: [], command: [], fit: [], native: [] };
  for (let k = 0; k < 12; k++) {
    await drop(page, read(name), name, 'image/png');
    const { ms, total } = await found(page);
    const start = performance.now();
    const out = execFileSync(dvp, ['fit', join(pictures, name), '--out', join(pictures, 'native'), '--threads', '1', '--json'], { encoding: 'utf8' });
    times.command.push(performance.now() - start);
    times.native.push(cpuOf(JSON.parse(out)));
    times.page.push(total);
    times.fit.push(ms);
  }
  const median = (values) => values.slice(2).sort((a, b) => a - b)[Math.floor((values.length - 2) / 2)];
  const [drops, command, fit, own] = [times.page, times.command, times.fit, times.native].map(median);
  console.log(`    from drop to objects ${drops.toFixed(1)} ms, the command ${command.toFixed(1)} ms: ${(drops / command).toFixed(2)} times`);
  console.log(`    the fit alone ${fit.toFixed(1)} ms, the command's ${own.toFixed(1)} ms: ${(fit / own).toFixed(2)} times`);
  assert.ok(Number.isFinite(drops + command + fit + own), 'times of both');
  if (!process.env.DVP_TIMES) return;
  assert.ok(drops <= 2.5 * command, 'from the drop to the objects');
  assert.ok(fit <= 2.5 * own, 'the fit alone');
});

const cpuOf = (report) => (report.pictures ?? report.images ?? [report]).map((one) => one.cpu_ms ?? NaN)[0];

check('edits: drag, turn, scale, recolor, reorder, delete, undo, redo', async () => {
  await drop(page, read('icon.png'), 'icon.png', 'image/png');
  await found(page);
  const start = await scene();
  const count = start.objects.length;
  await page.click('#list [role="option"]:last-child');
  await page.waitForSelector('.handles .frame');
  const first = (state) => state.objects[0];
  const drag = async (from, [dx, dy]) => {
    await page.mouse.move(...from);
    await page.mouse.down();
    for (const share of [0.3, 0.7, 1]) await page.mouse.move(from[0] + share * dx, from[1] + share * dy);
    await page.mouse.up();
  };
  const middle = async (selector, at = 0) => {
    const { x, y, width, height } = await page.locator(selector).nth(at).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  await drag(await middle('.pane:last-child .touch [data-object="0"]'), [40, 0]);
  const moved = await scene();
  assert.ok(first(moved).translation[0] > first(start).translation[0] + 0.02, 'dragged to the right');
  assert.equal(first(moved).known, undefined, 'what the fit knew of its place is forgotten');
  await page.keyboard.press('Control+z');
  assert.deepEqual(await scene(), start, 'undone');
  await page.keyboard.press('Control+Shift+z');
  assert.deepEqual(await scene(), moved, 'done again');
  await drag(await middle('.pane:last-child .reach', 3), [30, 30]);
  const scaled = await scene();
  assert.ok((first(scaled).scale ?? 1) > (first(moved).scale ?? 1) * 1.02, 'larger');
  await page.keyboard.press('.');
  const turned = await scene();
  const near = (a, b) => Math.abs(a - b) < 1e-9;
  assert.ok(near((first(turned).rotation ?? 0) - (first(scaled).rotation ?? 0), Math.PI / 36), 'turned by 5 degrees');
  await page.locator('#inspector input[type="color"]').fill('#00ff80');
  assert.deepEqual(first(await scene()).color.map((value) => Math.round(255 * value)), [0, 255, 128], 'another color');
  await page.locator('#stage').focus();
  await page.keyboard.press(']');
  const ordered = await scene();
  assert.deepEqual(ordered.objects[1].color.map((value) => Math.round(255 * value)), [0, 255, 128], 'painted later');
  const shot1 = await page.locator('#figures').textContent();
  assert.match(shot1, /edited/);
  await page.keyboard.press('Delete');
  await until(count - 1, 'one less');
  for (let k = 0; k < 6; k++) await page.click('#undo');
  assert.deepEqual(await scene(), start, 'all undone');
  assert.equal(await page.locator('#undo').isDisabled(), true);
  await page.click('#redo');
  assert.deepEqual(await scene(), moved);
  // Arrows move by whole pixels.
  await page.click('#list [role="option"]:last-child');
  await page.locator('#stage').focus();
  await page.keyboard.press('ArrowDown');
  const nudged = await scene();
  assert.ok(near(first(nudged).translation[1] - first(moved).translation[1], 1 / Math.min(start.width, start.height)), 'one pixel down');
});

check('views, zoom and the keyboard', async () => {
  for (const [key, mode] of [['2', 'wipe'], ['3', 'outlines'], ['4', 'result'], ['5', 'error'], ['1', 'beside']]) {
    await page.locator('#stage').focus();
    await page.keyboard.press(key);
    assert.equal(await page.getAttribute('#stage', 'data-mode'), mode);
    await shot(`view_${mode}`);
  }
  const transform = () => page.locator('.sheet').first().evaluate((sheet) => sheet.style.transform);
  const before = await transform();
  await page.keyboard.press('+');
  assert.notEqual(await transform(), before, 'zoomed');
  await page.keyboard.press('0');
  assert.equal(await transform(), before, 'and back');
  await page.locator('#list [role="option"]').first().hover();
  assert.ok((await page.locator('.touch .hovered').count()) > 0, 'hovering marks the object');
  await page.locator('#list [role="option"]').first().click();
  await page.keyboard.press('ArrowDown');
  assert.equal(await page.locator('#list [role="option"]').nth(1).getAttribute('aria-selected'), 'true', 'arrows choose in the list');
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('#list [aria-selected="true"]').count(), 0);
});

check('the error map tells where an edit went wrong', async () => {
  const error = async () => Number(/error ([\d.]+)/.exec(await page.textContent('#figures'))[1]);
  await drop(page, read('icon.png'), 'icon.png', 'image/png');
  await found(page);
  await settled();
  const before = await error();
  await page.click('#list [role="option"]:first-child');
  await page.locator('#stage').focus();
  for (let k = 0; k < 6; k++) await page.keyboard.press('Shift+ArrowRight');
  await page.waitForFunction((least) => Number(/error ([\d.]+)/.exec(document.getElementById('figures').textContent)[1]) > least + 0.1, before);
});

check('fit as you look: the drawing moves back to the picture', async () => {
  await drop(page, read('icon.png'), 'icon.png', 'image/png');
  await found(page);
  const truth = await scene();
  await page.click('#shake');
  const shaken = await scene();
  await page.click('#refine');
  await page.waitForFunction(() => /in [1-9]\d* steps/.test(document.querySelector('#curve figcaption').textContent));
  await shot('fit_as_you_look');
  await settled();
  await page.waitForTimeout(200);
  const [, from, to] = /error ([\d.e+-]+) → ([\d.e+-]+)/.exec(await page.textContent('#curve figcaption'));
  console.log(`    mean squared error ${from} → ${to}`);
  assert.ok(Number(to) < 0.05 * Number(from), 'at least 20 times better');
  const refined = await scene();
  const off = (state) => farthest(state.objects.map(({ color }) => color), truth.objects.map(({ color }) => color));
  assert.ok(off(refined) < off(shaken), 'colors come back');
  await page.click('#undo');
  assert.deepEqual(await scene(), shaken, 'one step to undo');
});

check('sliders: fewer objects, a bank', async () => {
  await page.click('#settings summary');
  await page.locator('#most').fill('1');
  await page.waitForFunction(() => document.querySelectorAll('#list [role="option"]').length <= 2);
  await page.locator('#most').fill('8');
  await settled();
  await page.selectOption('#bank', 'mdshr');
  await settled();
  await page.waitForTimeout(300);
  await page.selectOption('#bank', '');
  await settled();
  await page.click('#settings summary');
});

check('what is not flat is said to be so', async () => {
  await drop(page, gradient(), 'gradient.png', 'image/png');
  // A minute alone; a machine that does other things takes several.
  await found(page, 300_000);
  const text = await page.textContent('#verdict');
  console.log(`    ${text.trim().slice(0, 120)}`);
  assert.match(text, /not flat|better than one flat color|left unexplained/);
  assert.equal(await page.getAttribute('#verdict', 'data-level'), 'warning');
});

check('a large picture says that it takes long, and is canceled', async () => {
  await drop(page, Buffer.from(await crowd(), 'base64'), 'crowd.png', 'image/png');
  await page.waitForSelector('#progress:not([hidden])', { timeout: 60_000 });
  assert.match(await page.textContent('#progress-text'), /million pixels.* s$/);
  await shot('progress');
  await page.click('#cancel');
  assert.match(await message(), /Canceled/);
  await page.click('#message-close');
  await drop(page, read('icon.png'), 'icon.png', 'image/png');
  await found(page);
});

check('a photo of 20 MB, a corrupt file, an empty file, a picture of no size', async () => {
  const bytes = Buffer.from(await photo(), 'base64');
  assert.ok(bytes.length > 20e6, `${bytes.length} bytes`);
  await drop(page, bytes, 'photo.jpg', 'image/jpeg');
  assert.match(await message(60_000), /pixels.*most/s);
  await shot('message');
  await page.click('#message-action');
  // A minute alone; a machine that does other things takes several.
  await found(page, 300_000);
  assert.equal(await page.getAttribute('#verdict', 'data-level'), 'warning', 'a smaller copy of the photo is fitted, and said to be no drawing');
  const icon = read('icon.png');
  for (const [file, name, expected] of [
    [icon.subarray(0, icon.length >> 1), 'half.png', /damaged/],
    [bytes.subarray(0, bytes.length >> 1), 'half.jpg', /damaged/],
    [Buffer.from('this is no picture'), 'text.png', /damaged/],
    [Buffer.alloc(0), 'empty.png', /empty/],
    [noColumns(icon), 'flat.png', /damaged/],
    [Buffer.from('<svg xmlns="http://www.w3.org/2000/svg" width="0" height="0"/>'), 'none.svg', /damaged|no size/],
  ]) {
    await drop(page, file, name, name.endsWith('svg') ? 'image/svg+xml' : name.endsWith('jpg') ? 'image/jpeg' : 'image/png');
    const text = await message().catch(() => assert.fail(`${name}: no message`));
    assert.match(text, expected, name);
    assert.ok(text.includes(name), `${name} is named: ${text}`);
    await page.click('#message-close');
  }
  // And the next picture is fitted as if nothing had been.
  await drop(page, icon, 'icon.png', 'image/png');
  await found(page);
});

/** A PNG whose header says that it has no columns. */
function noColumns(png) {
  const copy = Buffer.from(png);
  copy.writeUInt32BE(0, 16);
  return copy;
}

/** A JPEG of noise, as large as photos of cameras are: the browser's own encoder makes it. */
const photo = () =>
  page.evaluate(async () => {
    const [width, height] = [5600, 4200];
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d');
    let seed = 1;
    for (let top = 0; top < height; top += 200) {
      const strip = context.createImageData(width, 200);
      for (let i = 0; i < strip.data.length; i++) {
        seed = (Math.imul(seed, 1664525) + 1013904223) | 0;
        strip.data[i] = (i & 3) === 3 ? 255 : 96 + ((seed >>> 24) & 127);
      }
      context.putImageData(strip, 0, top);
    }
    const blob = await canvas.convertToBlob({ type: 'image/jpeg', quality: 0.97 });
    const reader = new FileReader();
    return new Promise((resolve) => {
      reader.onload = () => resolve(reader.result.split(',')[1]);
      reader.readAsDataURL(blob);
    });
  });

/** A picture of 2600 x 2600 pixels with 2500 disks, which takes a while. */
const crowd = () =>
  page.evaluate(async () => {
    const canvas = new OffscreenCanvas(2600, 2600);
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, 2600, 2600);
    for (let k = 0; k < 2500; k++) {
      context.fillStyle = ['#c33', '#38a', '#5a3', '#a5c'][k % 4];
      context.beginPath();
      context.arc(26 + 52 * (k % 50), 26 + 52 * Math.floor(k / 50), 12 + (k % 11), 0, 2 * Math.PI);
      context.fill();
    }
    const reader = new FileReader();
    const blob = await canvas.convertToBlob({ type: 'image/png' });
    return new Promise((resolve) => {
      reader.onload = () => resolve(reader.result.split(',')[1]);
      reader.readAsDataURL(blob);
    });
  });

/** A picture of two gradients, as PNG. */
function gradient() {
  const png = new PNG({ width: 160, height: 120 });
  for (let i = 0; i < 160 * 120; i++) {
    const [x, y] = [(i % 160) / 159, Math.floor(i / 160) / 119];
    png.data.set([Math.round(255 * x), Math.round(255 * y), Math.round(127 + 127 * Math.sin(9 * (x + y))), 255], 4 * i);
  }
  return PNG.sync.write(png);
}

let failed = 0;
for (const { name, run } of checks) {
  try {
    await run();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED  ${name}\n${error.stack}`);
    await shot(`failed_${failed}`);
  }
}
if (problems.length) {
  failed += 1;
  console.log(`FAILED  no error on the console, no request elsewhere\n${problems.join('\n')}`);
} else console.log('ok      no error on the console, no request elsewhere');
await close();
console.log(`${basename(import.meta.url)}: ${checks.length + 1 - failed} of ${checks.length + 1} passed`);
process.exit(failed ? 1 : 0);
