// A browser and a server for the tests: the page in headless Chromium, every request and every message of its console on record.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import { chromium } from 'playwright-core';

const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
};

/** Serves a folder on a free port of this machine. */
async function serve(folder) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname));
    try {
      const body = await readFile(join(folder, path.endsWith('/') ? `${path}index.html` : path));
      response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? (path.endsWith('/') ? 'text/html' : 'application/octet-stream') });
      response.end(body);
    } catch {
      response.writeHead(404);
      response.end();
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return server;
}

/** The page of a folder in a browser. `problems` fills with errors of the console and requests elsewhere. */
export async function open(folder, settings = {}) {
  const server = await serve(folder);
  const origin = `http://127.0.0.1:${server.address().port}`;
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  });
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, ...settings });
  const page = await context.newPage();
  const problems = [];
  page.on('console', (message) => message.type() === 'error' && problems.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => problems.push(`error: ${error.message}`));
  context.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith(origin) && !/^(blob|data):/.test(url)) problems.push(`request elsewhere: ${url}`);
  });
  context.on('requestfailed', (request) => problems.push(`failed: ${request.url()}`));
  context.on('response', (response) => response.status() >= 400 && problems.push(`${response.status()}: ${response.url()}`));
  await page.goto(`${origin}/`);
  await page.waitForSelector('#samples img');
  return { page, problems, close: async () => (await browser.close(), server.close()) };
}

/** Drops bytes on the page, as a hand does; does not wait for what comes of it. */
export async function drop(page, bytes, name, type) {
  const transfer = await page.evaluateHandle(
    async ({ base64, name, type }) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const transfer = new DataTransfer();
      transfer.items.add(new File([bytes], name, { type }));
      return transfer;
    },
    { base64: Buffer.from(bytes).toString('base64'), name, type },
  );
  await page.evaluate(() => delete document.body.dataset.found);
  await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
}

/** Waits until the objects of the dropped picture are there; what the page says of it. A message in their place is an error. */
export async function found(page, timeout = 60_000) {
  const answer = () => document.body.dataset.found || !document.getElementById('message').hidden;
  await page.waitForFunction(answer, null, { timeout });
  const [json, message] = await page.evaluate(() => [document.body.dataset.found, document.getElementById('message-text').textContent]);
  if (!json) throw new Error(`the page says: ${message}`);
  return JSON.parse(json);
}
