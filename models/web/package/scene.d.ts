// The JSON of a scene, version 3, as `Picture.fit` and `Drawing.toJson` give it and `new Drawing` takes it.
// models/cli/schema/scene-3.schema.json says the same for programs.

/** x and y, in scene units: the shorter side of the picture is 1, its upper left corner 0, y down. */
export type Point = [number, number];
/** Red, green, blue, from 0 to 1. */
export type Color = [number, number, number];

export interface Scene {
  version: 3;
  /** Columns and rows of the picture. */
  width: number;
  height: number;
  /** `null` where there is nothing behind the objects. */
  background: Color | null;
  /** Of a transparent scene: what it is shown on where an image has no alpha. */
  matte?: Color;
  /** In the order of painting: later ones hide earlier ones under `over`. */
  objects: SceneObject[];
  edge?: { law: 'squared_distance' | 'distance' | 'area'; offset?: number; sigma?: number; cut?: number };
  compositing: 'blend' | 'over';
  known?: SceneKnown;
}

/** A shape and where it stands: v' = scale R(rotation) v + translation. */
export type SceneObject = Shape & {
  translation?: Point;
  /** 1 if missing. */
  scale?: number;
  /** Radians from +x to +y; 0 if missing. */
  rotation?: number;
  /** Beside a ramp the mean of its stops. */
  color: Color;
  /** What paints instead of the one color. */
  ramp?: Ramp;
  /** Opacity, and probability of being there; 1 if missing. */
  confidence?: number;
  known?: ObjectKnown;
};

/** Colors between stops, in the frame of the shape; before the first and behind the last stop the color stays. */
export type Ramp = {
  /** Offsets never fall: 0 at the first point of the ramp. */
  stops: { offset: number; color: Color }[];
} & (
  | { kind: 'linear'; /** Offsets 0 and 1. */ points: [Point, Point] }
  | { kind: 'radial'; /** The center; two points of the ellipse of offset 1, in conjugate directions. */ points: [Point, Point, Point] }
);

export type Shape =
  | { kind: 'circle'; radius: number }
  | { kind: 'ellipse'; radii: Point }
  | { kind: 'rectangle'; size: Point; corner_radius?: number }
  | { kind: 'regular_polygon'; sides: number; radius: number }
  | { kind: 'star'; points: number; radius: number; inner_radius: number }
  | { kind: 'polygon'; rings: Point[][] }
  | { kind: 'path'; rings: Ring[]; fill?: 'even_odd' | 'non_zero' }
  | { kind: 'stroke'; rings: Ring[]; width: number; cap: 'butt' | 'round' | 'square'; join: 'miter' | 'round' | 'bevel'; miter_limit?: number }
  | { kind: 'efd'; efd: [number, number, number, number][]; symmetry?: number }
  | { kind: 'prototype'; prototype: number; efd?: [number, number, number, number][]; symmetry?: number };

/** Points joined by segments; as many segments as points if it is closed, one less if it is open. */
export interface Ring {
  points: Point[];
  segments: Segment[];
}

export type Segment =
  | { kind: 'line' }
  | { kind: 'arc'; /** tan(sweep / 4); 1 for a half circle from +x to +y. */ bulge: number }
  | { kind: 'smooth_arc' }
  | { kind: 'cubic'; controls: [Point, Point] }
  | { kind: 'smooth_cubic'; handle: number; control: Point };

/** What a fit knows of its scene. */
export interface SceneKnown {
  stop: 'converged' | 'step_limit' | 'stalled' | 'empty' | 'not_flat' | 'no_better_than_flat' | 'other';
  /** Share of the picture's variance that neither the scene nor noise explains. */
  unexplained?: number;
  noise?: number;
  bits?: number;
  /** What the fit says against itself. */
  doubts: ('pose' | 'stop' | 'unexplained' | 'redundant' | 'invisible')[];
}

/** What a fit knows of an object. */
export interface ObjectKnown {
  /** Standard deviations, each in the unit of its number. */
  deviations?: { translation?: Point; scale?: number; rotation?: number; color?: Color; numbers?: Record<string, number> };
  /** What would be unexplained in addition without it, as a share of the picture's variance. */
  marginal_gain?: number;
  /** Intersection over union to expect of what is seen of it and what is there. */
  expected_iou?: number;
  doubts: Doubt[];
}

export type Doubt =
  | { kind: 'symmetry'; order: number }
  | { kind: 'cropped'; visible: number }
  | { kind: 'hidden'; share: number; completion: { kind: 'prototype' | 'rotation' | 'mirror' | 'straight' | 'other'; order?: number } }
  | { kind: 'merged'; other: number; visible: number }
  | { kind: 'twin'; prototype: number; ratio: number };

/** The text that `Picture.fit` returns, parsed. */
export interface Fitted {
  scene: Scene;
  /** Mean absolute error against the picture, channels from 0 to 1. */
  mae: number;
  /** Per object, row by row, the covariance of (x, y, log scale, rotation, log stretch), null where nothing is known; or empty. */
  covariance: (number | null)[][];
}

/** The text that `Picture.refine` returns, parsed. */
export interface Refined {
  scene: Scene;
  /** Mean squared error before and after. */
  start_loss: number;
  loss: number;
  steps: number;
  /** How many numbers could move. */
  numbers: number;
}
