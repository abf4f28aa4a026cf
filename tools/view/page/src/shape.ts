// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn in space: corners of triangles or lines, each with its colour, light included. A
// painter (glPainter.ts, softPainter.ts) shows them; the last corner's colour is that of the whole
// triangle or line.

import * as THREE from 'three';

export class Shape {
  readonly place: Float32Array;
  readonly colour: Uint32Array; // as packed() gives them
  readonly matrix = new THREE.Matrix4(); // to the frame that it is in
  count = 0; // corners that are shown
  version = 0; // of the corners
  visible = true;

  constructor(
    readonly kind: 'triangles' | 'lines',
    readonly most: number, // corners
    readonly opacity = 1,
  ) {
    this.place = new Float32Array(3 * most);
    this.colour = new Uint32Array(most);
  }

  begin(): void {
    this.count = 0;
  }
  get room(): number {
    return this.most - this.count;
  }
  add(x: number, y: number, z: number, colour: number): void {
    const at = 3 * this.count;
    this.place[at] = x;
    this.place[at + 1] = y;
    this.place[at + 2] = z;
    this.colour[this.count++] = colour;
  }
  end(): void {
    this.version++;
  }
}

export interface Placed {
  shape: Shape;
  matrix: THREE.Matrix4; // to the scene
}

// What the painters have in common. The picture's size is in its own pixels.
export interface Painter {
  paint(placed: Placed[], camera: THREE.PerspectiveCamera, back: string, width: number, height: number): void;
}

// Those that are seen, in the order of their drawing: what shines through comes last.
export const inOrder = (placed: Placed[]): Placed[] =>
  placed
    .filter(({ shape }) => shape.visible && shape.count > 0)
    .sort((a, b) => Number(a.shape.opacity < 1) - Number(b.shape.opacity < 1));

export function resize(canvas: HTMLCanvasElement, width: number, height: number): void {
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
}

const pack = (r: number, g: number, b: number): number => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
const plain = new Map<string, number>();

export function packed(name: string): number {
  let found = plain.get(name);
  if (found === undefined) {
    const rgb = new THREE.Color(name).getHex();
    found = pack(rgb >> 16, (rgb >> 8) & 255, rgb & 255);
    plain.set(name, found);
  }
  return found;
}

const SHADES = 32;
const BRIGHTEST = 4 / 3;
const shades = new Map<string, Uint32Array>();

// A colour in steps of light.
export function shadesOf(name: string): Uint32Array {
  let found = shades.get(name);
  if (found) return found;
  found = new Uint32Array(SHADES);
  const lit = new THREE.Color();
  const byte = (x: number) => Math.round(255 * Math.min(x, 1));
  for (let k = 0; k < SHADES; k++) {
    lit.set(name).multiplyScalar((BRIGHTEST * k) / (SHADES - 1)).convertLinearToSRGB();
    found[k] = pack(byte(lit.r), byte(lit.g), byte(lit.b));
  }
  shades.set(name, found);
  return found;
}

// Which of them, of a face whose normal has these components upwards and towards the sun: the sky
// lights it more than the ground does.
export function shadeOf(toUp: number, toSun: number): number {
  const light = 0.46 + 0.24 * toUp + 0.38 * Math.max(toSun, 0);
  return Math.round(Math.min(light / BRIGHTEST, 1) * (SHADES - 1));
}
