// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn over the film: boxes, ids, trails and strokes, on a context whose unit is the
// picture's pixel.

import { colourOnFootage } from './colours';
import { rowsOf, type BoxRows } from './frames';
import type { Run } from './run';
import { isShown } from './state';

export type Stroke = [number, number][];

export class Overlay {
  private lines: number[][] = []; // of each animal: x, y, x, y ..

  constructor(private run: Run) {}

  // `px` is the length of a pixel of the screen; `seamed`: there is a picture below.
  draw(g: CanvasRenderingContext2D, frame: number, px: number, seamed: boolean): void {
    this.drawTrails(g, frame, px, seamed);
    const rows = this.run.boxes.ahead(frame);
    if (rows) this.drawBoxes(g, rows, frame, px, seamed);
  }

  private drawBoxes(g: CanvasRenderingContext2D, rows: BoxRows, frame: number, px: number,
    seamed: boolean): void {
    const state = this.run.store.get();
    const [begin, end] = rowsOf(rows, frame);
    g.font = `600 ${11 * px}px system-ui, sans-serif`;
    for (let r = begin; r < end; r++) {
      const animal = rows.animal[r];
      if (!isShown(state, animal)) continue;
      const chosen = animal === state.selected || animal === state.second;
      const hovered = animal === state.hovered;
      const left = rows.box[4 * r];
      const top = rows.box[4 * r + 1];
      const width = rows.box[4 * r + 2];
      const height = rows.box[4 * r + 3];
      if (state.boxes || chosen || hovered) {
        if (seamed) {
          seam(g, px);
          g.strokeRect(left, top, width, height);
        }
        const unsure = rows.confidence[r] < 0.5;
        g.strokeStyle = chosen ? '#ffffff' : colourOnFootage(animal);
        g.lineWidth = (chosen ? 2.2 : hovered ? 2 : 1.2) * px;
        if (unsure) g.setLineDash([4 * px, 3 * px]);
        const grow = chosen ? 2 * px : 0;
        g.strokeRect(left - grow, top - grow, width + 2 * grow, height + 2 * grow);
        if (unsure) g.setLineDash([]);
      }
      if (state.ids || chosen) {
        const text = this.run.animals[animal] ?? '';
        g.lineWidth = 3 * px;
        g.strokeStyle = 'rgba(0, 0, 0, 0.6)';
        g.fillStyle = chosen ? '#ffffff' : colourOnFootage(animal);
        g.strokeText(text, left + width + 2 * px, top + 4 * px);
        g.fillText(text, left + width + 2 * px, top + 4 * px);
      }
    }
  }

  private drawTrails(g: CanvasRenderingContext2D, frame: number, px: number, seamed: boolean): void {
    const { run } = this;
    const state = run.store.get();
    if (state.trails === 0) return;
    const lines = this.gather(frame, 2 * px);
    g.globalAlpha = 0.8;
    for (let animal = 0; animal < lines.length; animal++) {
      const line = lines[animal];
      if (!line || line.length < 4) continue;
      const chosen = animal === state.selected;
      g.beginPath();
      g.moveTo(line[0], line[1]);
      for (let k = 2; k < line.length; k += 2) g.lineTo(line[k], line[k + 1]);
      if (seamed) {
        seam(g, px);
        g.stroke();
      }
      g.lineWidth = (chosen ? 2 : 1.3) * px;
      g.strokeStyle = chosen ? '#ffffff' : colourOnFootage(animal);
      g.stroke();
    }
    g.globalAlpha = 1;
  }

  // The way of each animal that is shown. What is nearer than `least` to the point before the last
  // takes the last one's place: every point costs time, and thousands of animals have many.
  private gather(frame: number, least: number): number[][] {
    const { run, lines } = this;
    const state = run.store.get();
    for (const line of lines) if (line) line.length = 0;
    for (let f = Math.max(frame - state.trails, run.clock.first); f <= frame; f++) {
      const rows = run.boxes.near(f);
      if (!rows) continue;
      const [begin, end] = rowsOf(rows, f);
      for (let r = begin; r < end; r++) {
        const animal = rows.animal[r];
        if (!isShown(state, animal)) continue;
        const line = (lines[animal] ??= []);
        const x = rows.box[4 * r] + rows.box[4 * r + 2] / 2;
        const y = rows.box[4 * r + 1] + rows.box[4 * r + 3] / 2;
        const n = line.length;
        if (n >= 4 && (x - line[n - 4]) ** 2 + (y - line[n - 3]) ** 2 < least * least) {
          line[n - 2] = x;
          line[n - 1] = y;
        } else {
          line.push(x, y);
        }
      }
    }
    return lines;
  }
}

// Light colours are to be seen on a bright sky too: a dark seam lies under them, where there is a
// picture. (Each line has its own: one path of thousands takes the browser seconds.)
function seam(g: CanvasRenderingContext2D, px: number): void {
  g.lineWidth = 2.6 * px;
  g.strokeStyle = 'rgba(0, 0, 0, 0.45)';
}

export function drawStrokes(g: CanvasRenderingContext2D, strokes: Stroke[], px: number): void {
  g.strokeStyle = '#ffd25a';
  g.lineWidth = 2.5 * px;
  g.lineJoin = g.lineCap = 'round';
  for (const stroke of strokes) {
    g.beginPath();
    stroke.forEach(([x, y], k) => (k === 0 ? g.moveTo(x, y) : g.lineTo(x, y)));
    g.stroke();
  }
}
