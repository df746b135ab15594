// Pictures to try.

const SAMPLES = [
  ['shapes.png', 'Shapes'],
  ['boat.png', 'Boat'],
  ['traffic_light.png', 'Traffic light'],
  ['cells.png', 'Cells'],
  ['bar_chart.png', 'Bar chart'],
  ['sticker.png', 'Sticker, transparent'],
  ['lens.jpg', 'JPEG'],
  ['ghost.png', 'Ghost'],
];

/** Fills a list with samples; `open` takes the file of the chosen one. */
export function showSamples(list, open) {
  for (const [file, name] of SAMPLES) {
    const address = new URL(`./samples/${file}`, import.meta.url);
    const image = Object.assign(document.createElement('img'), { src: address, alt: '', loading: 'lazy' });
    const button = Object.assign(document.createElement('button'), { type: 'button', title: name });
    button.setAttribute('aria-label', `Sample: ${name}`);
    button.append(image);
    button.addEventListener('click', async () => {
      const blob = await (await fetch(address)).blob();
      open(new File([blob], file, { type: blob.type }));
    });
    const item = document.createElement('li');
    item.append(button);
    list.append(item);
  }
}
