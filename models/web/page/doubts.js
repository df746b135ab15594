// What a fit says against itself, in words.

const percent = (share) => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;

const COMPLETION = {
  prototype: 'the known shape',
  rotation: 'the symmetry of what is seen',
  mirror: 'the mirror image of what is seen',
  straight: 'the shortest way across',
  other: 'what is seen',
};

/** One line per doubt about an object. */
export function doubtsOf(object) {
  return (object.known?.doubts ?? []).flatMap((doubt) => {
    switch (doubt.kind) {
      case 'cropped':
        return [`leaves the picture: ${percent(doubt.visible)} of its outline is seen`];
      case 'hidden':
        return [`${percent(doubt.share)} of its outline is hidden and guessed from ${COMPLETION[doubt.completion.kind]}`];
      case 'merged':
        return [`has run together with object ${doubt.other + 1} of its color`];
      case 'twin':
        return [`another known shape fits nearly as well`];
      // A disk has no angle: nothing to worry about.
      default:
        return [];
    }
  });
}

/** What the fit says of the scene: { level: 'good' | 'note' | 'warning', title, lines }. */
export function verdict(scene) {
  const { stop, unexplained, doubts = [] } = scene.known ?? {};
  const rest = unexplained === undefined ? '' : ` ${percent(unexplained)} of what varies in the picture is left unexplained.`;
  const count = scene.objects.length;
  if (doubts.includes('invisible')) return { level: 'warning', title: 'The picture is clear everywhere: there is nothing to see in it.', lines: [] };
  if (stop === 'not_flat') {
    const title = 'This picture is not flat: a photo, a gradient or a texture.';
    return { level: 'warning', title, lines: [`What you see comes nearest.${rest}`, 'dvp is for icons, diagrams, charts, flags and scans of plain things.'] };
  }
  if (stop === 'no_better_than_flat') {
    const title = 'No objects were found that explain the picture better than one flat color.';
    return { level: 'warning', title, lines: [`Photos, gradients and textures end like this.${rest}`] };
  }
  if (stop === 'empty') return { level: 'note', title: 'The picture is one flat color: there are no objects in it.', lines: [] };
  const lines = [];
  if (doubts.includes('unexplained')) lines.push(`More is in the picture than these objects say.${rest}`);
  if (doubts.includes('redundant')) lines.push('One object may be one too many.');
  if (doubts.includes('pose')) lines.push('An object may lie elsewhere: see ± in the list.');
  if (doubts.includes('stop')) lines.push('The fit stopped before it was done.');
  const objects = count === 1 ? '1 object' : `${count} objects`;
  if (!lines.length) return { level: 'good', title: `${objects}, without a doubt.`, lines };
  return { level: lines.length > 1 || doubts.includes('unexplained') ? 'warning' : 'note', title: `${objects}, with doubts.`, lines };
}
