// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The film with the tracks drawn over it. Picture and tracks are always of the same frame: tracks
// are drawn when their picture is, and a picture that comes late is drawn with its own tracks.

import { ground } from './colours';
import { rowOf, rowsOf, type BoxRows } from './frames';
import { canvasOver, flatContext, onCard } from './graphics';
import { Overlay, drawStrokes, type Stroke } from './overlay';
import { Pictures, type Picture } from './pictures';
import type { Run } from './run';
import { isShown } from './state';

export class FootageView {
  sheet: HTMLCanvasElement; // that is drawn on
  private pictures: Pictures;
  private overlay: Overlay;
  private shown: Picture | null = null;
  private zoom = 1;
  private panX = 0;
  private panY = 0;
  private reveal = false; // the selected animal, where it is out of sight
  strokes: Stroke[] = []; // of the sketch, and the one being drawn
  onPoint: ((x: number, y: number, animal: number, second: boolean) => void) | null = null;
  onStroke: ((stroke: Stroke) => void) | null = null;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private run: Run,
  ) {
    this.pictures = new Pictures(run);
    this.overlay = new Overlay(run);
    this.sheet = canvas;
    onCard(() => {
      this.sheet = canvasOver(canvas);
      run.clock.redraw();
    });
    new ResizeObserver(() => {
      const [width, height] = this.room();
      if (width !== this.sheet.width || height !== this.sheet.height) run.clock.redraw();
    }).observe(canvas);
    const { session, boxes } = run;
    // A picture that comes late is drawn with its own tracks, so nothing has to wait for it.
    run.clock.onNeed((frame) => !session.has.boxes || boxes.ahead(frame) !== undefined);
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
    const fit = Math.min(this.sheet.width / w, this.sheet.height / h);
    const scale = fit * this.zoom;
    return {
      scale,
      x: (this.sheet.width - w * scale) / 2 + this.panX,
      y: (this.sheet.height - h * scale) / 2 + this.panY,
    };
  }
  // Where an event is in the picture [px].
  private toPicture(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const ratio = this.sheet.width / Math.max(box.width, 1);
    const t = this.transform();
    return [
      ((event.clientX - box.left) * ratio - t.x) / t.scale - 0.5,
      ((event.clientY - box.top) * ratio - t.y) / t.scale - 0.5,
    ];
  }

  // The pixels that there are for the picture.
  private room(): [number, number] {
    const { clientWidth, clientHeight } = this.canvas;
    return [Math.round(clientWidth * devicePixelRatio), Math.round(clientHeight * devicePixelRatio)];
  }

  draw(): void {
    const { canvas, run, sheet } = this;
    const ratio = devicePixelRatio;
    const [width, height] = this.room();
    if (width === 0 || height === 0) return;
    if (sheet.width !== width || sheet.height !== height) {
      sheet.width = width;
      sheet.height = height;
    }
    const state = run.store.get();
    const { frame } = run.clock;
    this.shown = run.session.footage
      ? this.pictures.show(frame, state.playing)
      : { frame, bitmap: null };
    const g = flatContext(sheet, sheet !== canvas);
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
    // Lines grow with the type, so that they are seen on a large screen too.
    const type = parseFloat(getComputedStyle(document.documentElement).fontSize) / 13;
    const px = (type * ratio) / t.scale;
    this.overlay.draw(g, this.shown.frame, px, this.shown.bitmap !== null);
    drawStrokes(g, this.strokes, px);
    if (this.shown.frame !== run.source.pictured(frame)) {
      g.setTransform(1, 0, 0, 1, 0, 0);
      g.font = `${12 * ratio}px system-ui, sans-serif`;
      g.fillStyle = ground(state.dark).ink;
      g.fillText(`frame ${this.shown.frame}; ${frame} is on its way`, 10 * ratio, 20 * ratio);
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
    const { width, height } = this.sheet;
    const u = t.x + x * t.scale;
    const v = t.y + y * t.scale;
    if (u > 0 && v > 0 && u < width && v < height) return;
    this.panX += width / 2 - u;
    this.panY += height / 2 - v;
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
    const ratio = this.sheet.width / box.width;
    const x = (event.clientX - box.left) * ratio - this.sheet.width / 2;
    const y = (event.clientY - box.top) * ratio - this.sheet.height / 2;
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
    if (event.isTrusted) this.canvas.setPointerCapture(event.pointerId); // the crosshair is none
    const startX = event.clientX;
    const startY = event.clientY;
    const { panX, panY } = this;
    const ratio = this.sheet.width / this.canvas.getBoundingClientRect().width;
    const stroke: Stroke | null =
      this.run.store.get().mode === 'sketch' ? [this.toPicture(event)] : null;
    if (stroke) this.strokes.push(stroke);
    let moved = false;
    const move = (e: PointerEvent) => {
      moved ||= Math.hypot(e.clientX - startX, e.clientY - startY) > 4;
      if (stroke) {
        stroke.push(this.toPicture(e));
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
        if (stroke.length > 2) this.onStroke?.(stroke);
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
    const ratio = this.sheet.width / box.width;
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
