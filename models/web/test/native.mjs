// The module against the machine's own build: `node native.mjs DIST SCENE [FILE.png ...]`.
//
// SCENE is the example of dvp-wasm, built for this machine (`cargo build --release -p dvp-wasm --example scene`). Both are without std, so
// scenes must be the same, bit for bit. A JPEG's pixels are told by `coded`: a name that ends in `.jpg.png`.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { PNG } from 'pngjs';

const [dist, program, ...files] = process.argv.slice(2);
const { default: init, Picture } = await import(pathToFileURL(resolve(dist, 'dvp/dvp_wasm.js')));
await init({ module_or_path: readFileSync(join(dist, 'dvp/dvp_wasm_bg.wasm')) });

const folder = mkdtempSync(join(tmpdir(), 'dvp-'));
let failures = 0;
try {
  for (const file of files) {
    const { data, width, height } = PNG.sync.read(readFileSync(file));
    const coded = file.endsWith('.jpg.png');
    const pixels = join(folder, 'pixels');
    writeFileSync(pixels, data);
    const command = [pixels, width, height, coded].map(String);
    const native = execFileSync(program, command, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
    const picture = new Picture(data, width, height, coded);
    picture.fit(256, '');
    const start = performance.now();
    const wasm = picture.fit(256, '');
    const ms = performance.now() - start;
    picture.free();
    const same = wasm === native.trimEnd();
    if (!same) failures += 1;
    const count = JSON.parse(wasm).scene.objects.length;
    console.log(`${same ? 'same     ' : 'DIFFERENT'} ${basename(file)}: ${width} x ${height}, ${count} objects, ${ms.toFixed(1)} ms`);
  }
} finally {
  rmSync(folder, { recursive: true, force: true });
}
if (!files.length) throw new Error('no pictures to compare');
console.log(`${files.length - failures} of ${files.length} scenes are the same, bit for bit`);
process.exit(failures ? 1 : 0);
