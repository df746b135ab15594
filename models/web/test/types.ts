// What a user of the package writes, for the compiler to check.
import init, { Drawing, Picture, version } from '../dist/dvp/dvp_wasm.js';
import type { Fitted, Refined, Scene, Shape } from '../dist/dvp/scene.js';

export async function objectsOf(pixels: Uint8Array, width: number, height: number): Promise<string[]> {
  await init();
  const picture = new Picture(pixels, width, height, false);
  const { scene, mae, covariance }: Fitted = JSON.parse(picture.fit(256, ''));
  const drawing = new Drawing(JSON.stringify(scene), '');
  const svg: string = drawing.toSvg();
  const bytes: Uint8Array = drawing.paint(width, height);
  const numbers = Float32Array.from(covariance.flat().map((value) => value ?? NaN));
  const csv: string = drawing.toCsv('picture.png', numbers);
  const refined: Refined = JSON.parse(picture.refine(drawing, 100, (step: number, loss: number, json: string) => {
    const now: Scene = JSON.parse(json);
    return step + loss + now.objects.length;
  }));
  const comparison = picture.compare(drawing);
  const differences: Uint8Array = comparison.differences;
  // @ts-expect-error A picture has no such method.
  picture.paint();
  // @ts-expect-error There is no such shape.
  const wrong: Shape = { kind: 'blob' };
  return [version(), svg, csv, String(mae + bytes.length + refined.loss + differences.length), wrong.kind];
}
