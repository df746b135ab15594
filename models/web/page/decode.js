// Files to pixels: the browser decodes, without converting colors and without multiplying them by alpha.
//
// Differences from the command, which decodes by itself: pictures of 16 bits come with 8; a JPEG may differ by a few steps of 1/255,
// as decoders do; of an animation the first picture is taken by both.

/** Most pixels that are fitted as they are: 2^24, a square of 4096. */
export const MOST_PIXELS = 1 << 24;
/** Pixels that larger pictures are brought down to, if the user wants that. */
export const SMALLER_PIXELS = 1 << 21;
/** Pixels of the longer side that drawings (SVG) are painted with. */
const DRAWN_SIDE = 512;

/** A file that is no picture to fit; `picture` is one that is too large, which `reduced` makes smaller. */
export class DecodeError extends Error {
  constructor(message, bitmap = null) {
    super(message);
    this.name = 'DecodeError';
    this.bitmap = bitmap;
  }
}

/** The pixels of a file: { rgba, width, height, coded, name, bitmap }. Throws [`DecodeError`] with a text for people. */
export async function decode(file) {
  const name = file.name || 'pasted picture';
  if (file.size === 0) throw new DecodeError(`${name} is empty: it has 0 bytes.`);
  const head = new Uint8Array(await file.slice(0, 16).arrayBuffer());
  if (await isCutShort(file, head)) throw new DecodeError(`${name} is damaged: it ends before the picture does.`);
  const coded = head[0] === 0xff && head[1] === 0xd8 && head[2] === 0xff;
  const bitmap = isDrawing(file, head) ? await drawn(file, name) : await raster(file, name);
  const { width, height } = bitmap;
  if (width * height > MOST_PIXELS) {
    const megapixels = (count) => (count / 1e6).toFixed(1);
    throw new DecodeError(
      `${name} has ${width} × ${height} pixels (${megapixels(width * height)} million). ` +
        `The most that is fitted in a browser is ${megapixels(MOST_PIXELS)} million.`,
      { bitmap, name, coded },
    );
  }
  const pixels = await exact(file, bitmap);
  return { ...pixels, coded, name, bitmap };
}

/** A smaller copy of a picture that is too large. */
export async function reduced({ bitmap, name }) {
  const factor = Math.sqrt(SMALLER_PIXELS / (bitmap.width * bitmap.height));
  const [width, height] = [bitmap.width, bitmap.height].map((side) => Math.max(1, Math.round(side * factor)));
  const smaller = await createImageBitmap(bitmap, { resizeWidth: width, resizeHeight: height, resizeQuality: 'high' });
  // Averages of many pixels: what the coder did to each is gone.
  return { ...fromCanvas(smaller), coded: false, name, bitmap: smaller };
}

// Browsers fill what is missing of a picture with nothing; a fit would find objects in it.
async function isCutShort(file, head) {
  const starts = (...bytes) => bytes.every((byte, at) => head[at] === byte);
  if (starts(0x89, 0x50, 0x4e, 0x47)) {
    // The last chunk is IEND; programs may leave bytes after it.
    const view = new DataView(await file.arrayBuffer());
    let at = 8;
    while (at + 12 <= view.byteLength) {
      const [length, kind] = [view.getUint32(at), view.getUint32(at + 4)];
      if (kind === 0x49454e44) return false;
      at += 12 + length;
    }
    return true;
  }
  if (starts(0xff, 0xd8, 0xff)) {
    const end = new Uint8Array(await file.slice(-65_536).arrayBuffer());
    return !end.some((byte, at) => byte === 0xff && end[at + 1] === 0xd9);
  }
  if (starts(0x52, 0x49, 0x46, 0x46)) {
    const announced = new DataView(head.buffer).getUint32(4, true);
    return file.size < announced + 8;
  }
  return false;
}

function isDrawing(file, head) {
  const text = new TextDecoder().decode(head).trimStart();
  return file.type === 'image/svg+xml' || (/\.svg$/i.test(file.name ?? '') && text.startsWith('<'));
}

async function raster(file, name) {
  try {
    return await createImageBitmap(file, {
      premultiplyAlpha: 'none',
      colorSpaceConversion: 'none',
      imageOrientation: 'from-image',
    });
  } catch {
    throw new DecodeError(`${name} cannot be read: it is damaged, or no picture that this browser knows (PNG, JPEG, WebP, GIF, BMP, AVIF).`);
  }
}

async function drawn(file, name) {
  const address = URL.createObjectURL(new Blob([file], { type: 'image/svg+xml' }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const { naturalWidth: width, naturalHeight: height } = image;
    if (!width || !height) throw new Error('no size');
    const factor = Math.min(1, DRAWN_SIDE / Math.max(width, height));
    const canvas = new OffscreenCanvas(Math.max(1, Math.round(width * factor)), Math.max(1, Math.round(height * factor)));
    canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
    return await createImageBitmap(canvas, { premultiplyAlpha: 'none' });
  } catch {
    throw new DecodeError(`${name} cannot be drawn: it is damaged, or has no size.`);
  } finally {
    URL.revokeObjectURL(address);
  }
}

function fromCanvas(bitmap) {
  const { width, height } = bitmap;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  return { rgba: new Uint8Array(context.getImageData(0, 0, width, height).data.buffer), width, height };
}

// A canvas keeps colors times alpha, rounded: where pixels are neither clear nor opaque, their colors come back changed. The
// decoder itself gives them as they are, where the browser has one to ask (WebCodecs).
async function exact(file, bitmap) {
  const pixels = fromCanvas(bitmap);
  const { rgba, width, height } = pixels;
  let translucent = false;
  for (let i = 3; i < rgba.length && !translucent; i += 4) translucent = rgba[i] !== 255 && rgba[i] !== 0;
  if (!translucent || typeof ImageDecoder === 'undefined' || !file.type) return pixels;
  let decoder = null;
  try {
    const settings = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
    decoder = new ImageDecoder({ data: await file.arrayBuffer(), type: file.type, ...settings });
    const { image } = await decoder.decode();
    const fits = image.codedWidth === width && image.codedHeight === height;
    if (!fits || !/^(RGBA|BGRA)$/.test(image.format ?? '')) return pixels;
    const straight = new Uint8Array(4 * width * height);
    await image.copyTo(straight, { layout: [{ offset: 0, stride: 4 * width }] });
    if (image.format === 'BGRA') {
      for (let i = 0; i < straight.length; i += 4) [straight[i], straight[i + 2]] = [straight[i + 2], straight[i]];
    }
    image.close();
    return { rgba: straight, width, height };
  } catch {
    return pixels;
  } finally {
    decoder?.close();
  }
}
