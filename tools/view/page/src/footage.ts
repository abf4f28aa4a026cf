// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The film with the tracks drawn over it. Picture and tracks are always of the same frame: tracks
// are drawn when their picture is, and a picture that comes late is drawn with its own tracks.

import { colourOnFootage, ground } from './colours';
import { flatContext } from './graphics';
import { rowsOf, rowOf, type BoxRows } from './frames';
import type { Run } from './run';
import { isShown } from './state';

interface Picture {
  frame: number;
  bitmap: ImageBitmap | null;
}
export interface Drawing {
  points: [number, number][];
}

const KEPT = 48; // pictures

export class FootageView {
  private pictures = new Map<number, Picture>();
  private waiting = new Map<number, AbortController>();
  private shown: Picture | null = null;
  private zoom = 1;
  private panX = 0;
  private panY = 0;
  private reveal = false; // the selected animal, where it is out of sight
  strokes: Drawing[] = []; // of the sketch, and the one being drawn
  onPoint: ((x: number, y: number, animal: number, second: boolean) => void) | null = null;
  onStroke: ((points: [number, number][]) => void) | null = null;

  constructor(
    private canvas: HTMLCanvasElement,
    private run: Run,
  ) {
    new ResizeObserver(() => run.clock.redraw()).observe(canvas);
    const { session, boxes, store } = run;
    // A picture that comes late is drawn with its own tracks, so nothing has to wait for it.
    run.clock.onNeed(() => !session.has.boxes || boxes.ahead(store.get().frame) !== undefined);
    run.clock.onDraw(() => this.draw());
    run.store.watch((state, before) => {
      if (state.selected !== before.selected) this.reveal = this.zoom > 1;
    });
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.hover(event));
    canvas.addEventListener('pointerleave', () => run.store.set({ hovered: -1 }));
    canvas.addEventListener('dblclick', () => this.fit());
  }

  get size(): [number, number] {
    const s = this.run.session;
    const from = s.footage ?? s.camera;
    return from ? [from.width, from.height] : [1280, 720];
  }
  // The frame in sight, for tests: that of the picture, not the one asked for.
  get frame(): number {
    return this.shown?.frame ?? 0;
  }
  fit(): void {
    this.zoom = 1;
    this.panX = this.panY = 0;
    this.run.clock.redraw();
  }

  // Canvas pixels of a picture's pixel: scale and offset.
  private transform(): { scale: number; x: number; y: number } {
    const [w, h] = this.size;
    const fit = Math.min(this.canvas.width / w, this.canvas.height / h);
    const scale = fit * this.zoom;
    return {
      scale,
      x: (this.canvas.width - w * scale) / 2 + this.panX,
      y: (this.canvas.height - h * scale) / 2 + this.panY,
    };
  }
  // Where an event is in the picture [px].
  private toPicture(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const ratio = this.canvas.width / Math.max(box.width, 1);
    const t = this.transform();
    return [
      ((event.clientX - box.left) * ratio - t.x) / t.scale - 0.5,
      ((event.clientY - box.top) * ratio - t.y) / t.scale - 0.5,
    ];
  }

  private ask(frame: number): void {
    const { footage } = this.run.session;
    if (!footage || frame < 1 || frame > footage.frames) return;
    if (this.pictures.has(frame) || this.waiting.has(frame)) return;
    const abort = new AbortController();
    this.waiting.set(frame, abort);
    const width = Math.min(footage.width, 1920);
    this.run.source
      .picture(frame, width, abort.signal)
      .then((blob) => createImageBitmap(blob))
      .then((bitmap) => {
        this.pictures.set(frame, { frame, bitmap });
        while (this.pictures.size > KEPT) {
          const oldest = this.pictures.keys().next().value as number;
          if (this.shown?.frame !== oldest) this.pictures.get(oldest)?.bitmap?.close();
          this.pictures.delete(oldest);
        }
        this.run.clock.redraw();
      })
      .catch((error: unknown) => {
        if (!abort.signal.aborted) this.run.store.fail(error);
      })
      .finally(() => this.waiting.delete(frame));
  }

  draw(): void {
    const { canvas } = this;
    const ratio = devicePixelRatio;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const state = this.run.store.get();
    if (this.run.session.footage) {
      const frame = this.run.source.pictured(state.frame);
      const picture = this.pictures.get(frame);
      if (picture) this.shown = picture;
      // What is not near the frame any more is not worth waiting for.
      for (const [waited, abort] of this.waiting) {
        if (Math.abs(waited - frame) > 8) abort.abort();
      }
      this.ask(frame);
      const lead = state.playing ? 6 : 1;
      for (let k = 1; k <= lead; k++) {
        if (this.waiting.size < 4) this.ask(this.run.source.pictured(state.frame + k));
      }
    } else {
      this.shown = { frame: state.frame, bitmap: null };
    }
    const g = flatContext(canvas);
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.fillStyle = ground(state.dark).back;
    g.fillRect(0, 0, width, height);
    if (!this.shown) return;
    if (this.reveal) this.centreOn(state.selected);
    const t = this.transform();
    const [w, h] = this.size;
    g.setTransform(t.scale, 0, 0, t.scale, t.x, t.y);
    g.imageSmoothingEnabled = t.scale < 3;
    if (this.shown.bitmap) {
      g.drawImage(this.shown.bitmap, 0, 0, w, h);
    } else {
      g.fillStyle = '#1b222b';
      g.fillRect(0, 0, w, h);
    }
    // The centre of a picture's first pixel is (0, 0); the canvas has its corner there.
    g.setTransform(t.scale, 0, 0, t.scale, t.x + 0.5 * t.scale, t.y + 0.5 * t.scale);
    this.drawTrails(g, this.shown.frame, t.scale);
    this.drawBoxes(g, this.shown.frame, t.scale);
    this.drawStrokes(g, t.scale);
    if (this.shown.frame !== this.run.source.pictured(state.frame)) {
      g.setTransform(1, 0, 0, 1, 0, 0);
      g.font = `${12 * ratio}px system-ui, sans-serif`;
      g.fillStyle = ground(state.dark).ink;
      g.fillText(`frame ${this.shown.frame}; ${state.frame} is on its way`, 10 * ratio, 20 * ratio);
    }
    canvas.dataset.frame = String(this.shown.frame);
  }

  private centreOn(animal: number): void {
    const rows = this.run.boxes.at(this.frame);
    const r = rows ? rowOf(rows, this.frame, animal) : -1;
    if (!rows || r < 0 || this.frame !== this.run.store.get().frame) return;
    this.reveal = false;
    const [x, y] = centreOfBox(rows, r);
    const t = this.transform();
    const { width, height } = this.canvas;
    const u = t.x + x * t.scale;
    const v = t.y + y * t.scale;
    if (u > 0 && v > 0 && u < width && v < height) return;
    this.panX += width / 2 - u;
    this.panY += height / 2 - v;
  }

  private drawBoxes(g: CanvasRenderingContext2D, frame: number, scale: number): void {
    const rows = this.run.boxes.ahead(frame);
    if (!rows) return;
    const state = this.run.store.get();
    const [begin, end] = rowsOf(rows, frame);
    const px = devicePixelRatio / scale;
    g.font = `600 ${11 * px}px system-ui, sans-serif`;
    for (let r = begin; r < end; r++) {
      const animal = rows.animal[r];
      if (!isShown(state, animal)) continue;
      const chosen = animal === state.selected || animal === state.second;
      const [left, top, w, h] = rows.box.subarray(4 * r, 4 * r + 4);
      if (state.boxes || chosen || animal === state.hovered) {
        if (this.seam(g, px)) g.strokeRect(left, top, w, h);
        g.strokeStyle = chosen ? '#ffffff' : colourOnFootage(animal);
        g.lineWidth = (chosen ? 2.2 : animal === state.hovered ? 2 : 1.2) * px;
        g.setLineDash(rows.confidence[r] < 0.5 ? [4 * px, 3 * px] : []);
        const grow = chosen ? 2 * px : 0;
        g.strokeRect(left - grow, top - grow, w + 2 * grow, h + 2 * grow);
        g.setLineDash([]);
      }
      if (state.ids || chosen) {
        const text = this.run.animals[animal] ?? '';
        g.lineWidth = 3 * px;
        g.strokeStyle = 'rgba(0, 0, 0, 0.6)';
        g.fillStyle = chosen ? '#ffffff' : colourOnFootage(animal);
        g.strokeText(text, left + w + 2 * px, top + 4 * px);
        g.fillText(text, left + w + 2 * px, top + 4 * px);
      }
    }
  }

  private drawTrails(g: CanvasRenderingContext2D, frame: number, scale: number): void {
    const state = this.run.store.get();
    if (state.trails === 0) return;
    const px = devicePixelRatio / scale;
    const lines = new Map<number, [number, number][]>();
    for (let f = frame - state.trails; f <= frame; f++) {
      const rows = this.run.boxes.near(Math.max(f, this.run.clock.first));
      if (!rows) continue;
      const [begin, end] = rowsOf(rows, f);
      for (let r = begin; r < end; r++) {
        const animal = rows.animal[r];
        if (!isShown(state, animal)) continue;
        const p: [number, number] = centreOfBox(rows, r);
        const line = lines.get(animal);
        if (!line) {
          lines.set(animal, [p]);
          continue;
        }
        // What is nearer than two pixels to the point before the last takes the last one's place:
        // every point costs time, and thousands of animals have many.
        const before = line[line.length - 2];
        const near = before && Math.hypot(p[0] - before[0], p[1] - before[1]) < 2 * px;
        if (near) line[line.length - 1] = p;
        else line.push(p);
      }
    }
    g.globalAlpha = 0.8;
    for (const [animal, line] of lines) {
      const chosen = animal === state.selected;
      g.beginPath();
      line.forEach(([x, y], k) => (k === 0 ? g.moveTo(x, y) : g.lineTo(x, y)));
      if (this.seam(g, px)) g.stroke();
      g.lineWidth = (chosen ? 2 : 1.3) * px;
      g.strokeStyle = chosen ? '#ffffff' : colourOnFootage(animal);
      g.stroke();
    }
    g.globalAlpha = 1;
  }

  // Light colours are to be seen on a bright sky too: a dark seam lies under them, where there is a
  // picture. (Each line has its own: one path of thousands takes the browser seconds.)
  private seam(g: CanvasRenderingContext2D, px: number): boolean {
    g.lineWidth = 2.6 * px;
    g.strokeStyle = 'rgba(0, 0, 0, 0.45)';
    return Boolean(this.shown?.bitmap);
  }

  private drawStrokes(g: CanvasRenderingContext2D, scale: number): void {
    g.strokeStyle = '#ffd25a';
    g.lineWidth = (2.5 * devicePixelRatio) / scale;
    g.lineJoin = g.lineCap = 'round';
    for (const stroke of this.strokes) {
      g.beginPath();
      stroke.points.forEach(([x, y], k) => (k === 0 ? g.moveTo(x, y) : g.lineTo(x, y)));
      g.stroke();
    }
  }

  // The animal at a place of the picture: in its box or within a few pixels of the screen.
  private animalAt(x: number, y: number): number {
    const rows = this.run.boxes.at(this.frame);
    if (!rows) return -1;
    const state = this.run.store.get();
    const reach = (10 * devicePixelRatio) / this.transform().scale;
    let best = -1;
    let least = Infinity;
    const [begin, end] = rowsOf(rows, this.frame);
    for (let r = begin; r < end; r++) {
      if (!isShown(state, rows.animal[r])) continue;
      const [left, top, w, h] = rows.box.subarray(4 * r, 4 * r + 4);
      const outside = Math.hypot(
        Math.max(left - x, 0, x - left - w),
        Math.max(top - y, 0, y - top - h),
      );
      const middle = Math.hypot(left + w / 2 - x, top + h / 2 - y);
      if (outside > reach || outside * 10 + middle >= least) continue;
      least = outside * 10 + middle;
      best = rows.animal[r];
    }
    return best;
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const box = this.canvas.getBoundingClientRect();
    const ratio = this.canvas.width / box.width;
    const x = (event.clientX - box.left) * ratio - this.canvas.width / 2;
    const y = (event.clientY - box.top) * ratio - this.canvas.height / 2;
    const zoom = Math.min(Math.max(this.zoom * Math.exp(-event.deltaY / 400), 1), 40);
    const factor = zoom / this.zoom;
    this.panX = zoom === 1 ? 0 : x - factor * (x - this.panX);
    this.panY = zoom === 1 ? 0 : y - factor * (y - this.panY);
    this.zoom = zoom;
    this.run.clock.redraw();
  }

  private hover(event: PointerEvent): void {
    if (event.buttons === 0) this.run.store.set({ hovered: this.animalAt(...this.toPicture(event)) });
  }

  private down(event: PointerEvent): void {
    this.canvas.setPointerCapture(event.pointerId);
    const startX = event.clientX;
    const startY = event.clientY;
    const { panX, panY } = this;
    const ratio = this.canvas.width / this.canvas.getBoundingClientRect().width;
    const stroke: Drawing | null =
      this.run.store.get().mode === 'sketch' ? { points: [this.toPicture(event)] } : null;
    if (stroke) this.strokes.push(stroke);
    let moved = false;
    const move = (e: PointerEvent) => {
      moved ||= Math.hypot(e.clientX - startX, e.clientY - startY) > 4;
      if (stroke) {
        stroke.points.push(this.toPicture(e));
      } else if (moved && this.zoom > 1) {
        this.panX = panX + (e.clientX - startX) * ratio;
        this.panY = panY + (e.clientY - startY) * ratio;
      }
      this.run.clock.redraw();
    };
    const up = (e: PointerEvent) => {
      this.canvas.removeEventListener('pointermove', move);
      this.canvas.removeEventListener('pointerup', up);
      if (stroke) {
        this.strokes.pop();
        if (stroke.points.length > 2) this.onStroke?.(stroke.points);
        this.run.clock.redraw();
        return;
      }
      if (moved) return;
      const [x, y] = this.toPicture(e);
      this.onPoint?.(x, y, this.animalAt(x, y), e.shiftKey);
    };
    this.canvas.addEventListener('pointermove', move);
    this.canvas.addEventListener('pointerup', up);
  }

  // For tests and the mend panel: where an animal is on the screen [CSS px].
  onScreen(animal: number): [number, number] | null {
    const rows = this.run.boxes.at(this.frame);
    const r = rows ? rowOf(rows, this.frame, animal) : -1;
    if (!rows || r < 0) return null;
    const [x, y] = centreOfBox(rows, r);
    const t = this.transform();
    const box = this.canvas.getBoundingClientRect();
    const ratio = this.canvas.width / box.width;
    return [
      box.left + (t.x + (x + 0.5) * t.scale) / ratio,
      box.top + (t.y + (y + 0.5) * t.scale) / ratio,
    ];
  }
}

function centreOfBox(rows: BoxRows, r: number): [number, number] {
  return [
    rows.box[4 * r] + rows.box[4 * r + 2] / 2,
    rows.box[4 * r + 1] + rows.box[4 * r + 3] / 2,
  ];
}
