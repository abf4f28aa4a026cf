// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shapes drawn by the processor, where there is no graphics card: flat triangles and lines, with
// their depth in a buffer. A browser's emulation of a card takes some two microseconds for each of
// them, however few pixels it has; this, about a tenth.

import * as THREE from 'three';

import { inOrder, packed, resize, type Painter, type Placed, type Shape } from './shape';

export class SoftPainter implements Painter {
  private flat: CanvasRenderingContext2D;
  private image = new ImageData(1, 1);
  private pixels = new Uint32Array(1);
  private depth = new Float32Array(1);
  private width = 1;
  private height = 1;
  private transform = new THREE.Matrix4();
  private corners = new Float64Array(0); // clip coordinates x, y, z, w

  constructor(private canvas: HTMLCanvasElement) {
    this.flat = canvas.getContext('2d', { willReadFrequently: true, alpha: false }) as CanvasRenderingContext2D;
  }

  paint(placed: Placed[], camera: THREE.PerspectiveCamera, back: string, width: number, height: number): void {
    resize(this.canvas, width, height);
    this.fit(width, height);
    this.pixels.fill(packed(back));
    this.depth.fill(1);
    camera.updateMatrixWorld();
    this.transform.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    const all = new THREE.Matrix4();
    for (const { shape, matrix } of inOrder(placed)) {
      this.project(shape, all.multiplyMatrices(this.transform, matrix).elements);
      if (shape.kind === 'lines') this.drawLines(shape);
      else this.drawTriangles(shape);
    }
    this.flat.putImageData(this.image, 0, 0);
  }

  private fit(width: number, height: number): void {
    if (this.width === width && this.height === height) return;
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
  }

  private project(shape: Shape, m: ArrayLike<number>): void {
    const { place, count } = shape;
    if (this.corners.length < 4 * count) this.corners = new Float64Array(8 * count);
    const to = this.corners;
    for (let k = 0; k < count; k++) {
      const x = place[3 * k], y = place[3 * k + 1], z = place[3 * k + 2];
      to[4 * k] = m[0] * x + m[4] * y + m[8] * z + m[12];
      to[4 * k + 1] = m[1] * x + m[5] * y + m[9] * z + m[13];
      to[4 * k + 2] = m[2] * x + m[6] * y + m[10] * z + m[14];
      to[4 * k + 3] = m[3] * x + m[7] * y + m[11] * z + m[15];
    }
  }

  private drawLines(shape: Shape): void {
    const c = this.corners;
    for (let k = 0; k + 1 < shape.count; k += 2) {
      const a = 4 * k, b = a + 4;
      // What is left of it, from s to t, between the near plane and the picture's edges.
      let s = 0, t = 1;
      for (let plane = 0; plane < 5; plane++) {
        const p = inside(c, a, plane), q = inside(c, b, plane);
        if (p < 0 && q < 0) t = -1;
        else if (p < 0) s = Math.max(s, p / (p - q));
        else if (q < 0) t = Math.min(t, p / (p - q));
      }
      if (s >= t) continue;
      const at = (u: number, axis: number) => c[a + axis] + u * (c[b + axis] - c[a + axis]);
      const ws = 1 / at(s, 3), wt = 1 / at(t, 3);
      this.line(this.toX(at(s, 0) * ws), this.toY(at(s, 1) * ws), at(s, 2) * ws,
        this.toX(at(t, 0) * wt), this.toY(at(t, 1) * wt), at(t, 2) * wt, shape.colour[k + 1], shape.opacity);
    }
  }

  private toX(x: number): number {
    return (x + 1) * 0.5 * this.width;
  }
  private toY(y: number): number {
    return (1 - y) * 0.5 * this.height;
  }

  private line(ax: number, ay: number, az: number, bx: number, by: number, bz: number, colour: number,
    opacity: number): void {
    const { pixels, depth, width, height } = this;
    const steps = Math.max(Math.ceil(Math.max(Math.abs(bx - ax), Math.abs(by - ay))), 1);
    const dx = (bx - ax) / steps, dy = (by - ay) / steps, dz = (bz - az) / steps;
    const share = Math.round(256 * opacity);
    for (let k = 0; k < steps; k++, ax += dx, ay += dy, az += dz) {
      const x = ax | 0, y = ay | 0;
      if (x >= width || y >= height || x < 0 || y < 0) continue;
      const at = y * width + x;
      if (az > depth[at]) continue;
      if (share === 256) {
        depth[at] = az;
        pixels[at] = colour;
      } else {
        pixels[at] = blend(colour, pixels[at], share);
      }
    }
  }

  private drawTriangles(shape: Shape): void {
    const c = this.corners;
    for (let k = 0; k + 2 < shape.count; k += 3) {
      const a = 4 * k;
      const colour = shape.colour[k + 2];
      const n0 = inside(c, a, 4), n1 = inside(c, a + 4, 4), n2 = inside(c, a + 8, 4);
      if (n0 >= 0 && n1 >= 0 && n2 >= 0) {
        const w0 = 1 / c[a + 3], w1 = 1 / c[a + 7], w2 = 1 / c[a + 11];
        this.triangle(this.toX(c[a] * w0), this.toY(c[a + 1] * w0), c[a + 2] * w0,
          this.toX(c[a + 4] * w1), this.toY(c[a + 5] * w1), c[a + 6] * w1,
          this.toX(c[a + 8] * w2), this.toY(c[a + 9] * w2), c[a + 10] * w2, colour, shape.opacity);
      } else if (n0 >= 0 || n1 >= 0 || n2 >= 0) {
        this.clipped(a, [n0, n1, n2], colour, shape.opacity);
      }
    }
  }

  // A triangle that reaches through the near plane: three or four corners are left of it.
  private clipped(a: number, near: number[], colour: number, opacity: number): void {
    const c = this.corners;
    const left: number[][] = [];
    for (let k = 0; k < 3; k++) {
      const n = (k + 1) % 3;
      const at = (u: number) => {
        const [x, y, z, w] = [0, 1, 2, 3].map((axis) =>
          c[a + 4 * k + axis] + u * (c[a + 4 * n + axis] - c[a + 4 * k + axis]));
        return [this.toX(x / w), this.toY(y / w), z / w];
      };
      if (near[k] >= 0) left.push(at(0));
      if (near[k] < 0 !== near[n] < 0) left.push(at(near[k] / (near[k] - near[n])));
    }
    for (let k = 2; k < left.length; k++) {
      const [p, q, r] = [left[0], left[k - 1], left[k]];
      this.triangle(p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2], colour, opacity);
    }
  }

  // Row by row, each pixel whose middle is inside; depth is linear over the picture.
  private triangle(ax: number, ay: number, az: number, bx: number, by: number, bz: number, cx: number,
    cy: number, cz: number, colour: number, opacity: number): void {
    const { pixels, depth, width, height } = this;
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) return;
    const top = Math.max(Math.ceil(Math.min(ay, by, cy) - 0.5), 0);
    const end = Math.min(Math.ceil(Math.max(ay, by, cy) - 0.5), height);
    const zx = ((bz - az) * (cy - ay) - (cz - az) * (by - ay)) / area;
    const zy = ((cz - az) * (bx - ax) - (bz - az) * (cx - ax)) / area;
    const share = Math.round(256 * opacity);
    for (let y = top; y < end; y++) {
      const v = y + 0.5;
      let low = Infinity, high = -Infinity;
      // Where the row meets the edges.
      if (ay <= v !== by <= v) {
        const x = ax + ((v - ay) / (by - ay)) * (bx - ax);
        if (x < low) low = x;
        if (x > high) high = x;
      }
      if (by <= v !== cy <= v) {
        const x = bx + ((v - by) / (cy - by)) * (cx - bx);
        if (x < low) low = x;
        if (x > high) high = x;
      }
      if (cy <= v !== ay <= v) {
        const x = cx + ((v - cy) / (ay - cy)) * (ax - cx);
        if (x < low) low = x;
        if (x > high) high = x;
      }
      const from = Math.max(Math.ceil(low - 0.5), 0);
      const to = Math.min(Math.ceil(high - 0.5), width);
      let z = az + (from + 0.5 - ax) * zx + (v - ay) * zy;
      for (let at = y * width + from; at < y * width + to; at++, z += zx) {
        if (z > depth[at]) continue;
        if (share === 256) {
          depth[at] = z;
          pixels[at] = colour;
        } else {
          pixels[at] = blend(colour, pixels[at], share);
        }
      }
    }
  }
}

// How far a corner is inside of a plane: left, right, bottom, top, near.
function inside(c: Float64Array, at: number, plane: number): number {
  const w = c[at + 3];
  return plane === 0 ? w + c[at] : plane === 1 ? w - c[at] : plane === 2 ? w + c[at + 1]
    : plane === 3 ? w - c[at + 1] : w + c[at + 2];
}

// `share` of 256 parts of a colour over another.
function blend(over: number, under: number, share: number): number {
  const rest = 256 - share;
  const redBlue = (Math.imul(over & 0xff00ff, share) + Math.imul(under & 0xff00ff, rest)) >>> 8;
  const green = (Math.imul(over & 0xff00, share) + Math.imul(under & 0xff00, rest)) >>> 8;
  return (0xff000000 | (redBlue & 0xff00ff) | (green & 0xff00)) >>> 0;
}
