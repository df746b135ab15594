// Results as files.

/** Hands a file to the user. */
export function download(content, name, type) {
  const address = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  const link = Object.assign(document.createElement('a'), { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Painted pixels as PNG. */
export function toPng({ pixels, width, height }) {
  const canvas = Object.assign(document.createElement('canvas'), { width, height });
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer, pixels.byteOffset, pixels.byteLength), width, height);
  canvas.getContext('2d').putImageData(image, 0, 0);
  return new Promise((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the picture is too large for a PNG of this browser'))), 'image/png');
  });
}

/** The name of a picture without its ending. */
export const stemOf = (name) => name.replace(/\.[^.]*$/, '') || 'picture';
