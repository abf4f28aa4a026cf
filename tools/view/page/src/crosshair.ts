// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A pointer that keys move over a picture, for who has no mouse: what it does there is what the
// mouse does there, for the picture hears the same events.

import type { Key } from './keys';

const STEP = 12; // CSS px
const FINE = 1;
const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};

export class Crosshair {
  private mark = document.createElement('i');
  private over: HTMLCanvasElement | null = null; // the picture; null: it is not in sight
  private x = 0; // CSS px from the picture's corner
  private y = 0;
  private pressed = false;

  constructor() {
    this.mark.className = 'crosshair';
  }

  get shown(): boolean {
    return this.over !== null;
  }

  // At a place of the screen [CSS px], else in the middle of the picture.
  show(over: HTMLCanvasElement, at: [number, number] | null = null): void {
    this.hide();
    const box = over.getBoundingClientRect();
    this.over = over;
    this.x = at ? at[0] - box.left : box.width / 2;
    this.y = at ? at[1] - box.top : box.height / 2;
    over.parentElement?.append(this.mark);
    over.focus(); // its keys are not those of a panel
    this.move(0, 0);
  }
  hide(): void {
    if (this.pressed) this.press();
    this.mark.remove();
    this.over = null;
  }
  // Over the next of the pictures; after the last of them, gone.
  cycle(pictures: HTMLCanvasElement[]): void {
    const next = pictures[this.over ? pictures.indexOf(this.over) + 1 : 0];
    if (next) this.show(next);
    else this.hide();
  }

  private move(dx: number, dy: number): void {
    const { over } = this;
    if (!over) return;
    this.x = Math.min(Math.max(this.x + dx, 0), over.clientWidth - 1);
    this.y = Math.min(Math.max(this.y + dy, 0), over.clientHeight - 1);
    this.mark.style.transform = `translate(${this.x}px, ${this.y}px)`;
    this.send('pointermove', false);
  }
  private click(shift: boolean): void {
    if (this.pressed) return this.press();
    this.send('pointerdown', shift);
    this.send('pointerup', shift);
  }
  // Down, or up again: between the two it drags.
  private press(): void {
    this.pressed = !this.pressed;
    this.mark.classList.toggle('pressed', this.pressed);
    this.send(this.pressed ? 'pointerdown' : 'pointerup', false);
  }
  private send(type: string, shiftKey: boolean): void {
    const { over } = this;
    if (!over) return;
    const box = over.getBoundingClientRect();
    over.dispatchEvent(new PointerEvent(type, { bubbles: true, cancelable: true, shiftKey,
      button: type === 'pointermove' ? -1 : 0, buttons: this.pressed ? 1 : 0,
      clientX: box.left + this.x, clientY: box.top + this.y }));
  }

  // Its keys; the arrows are its own while it is in sight. `away` hears that it was sent away.
  keys(pictures: () => HTMLCanvasElement[], away: () => void = () => undefined): Key[] {
    const key = (keys: string[], shown: string, text: string, act: (name: string) => void): Key =>
      ({ keys, shown, text, group: 'Crosshair', act, when: () => this.shown });
    const arrows = Object.keys(ARROWS);
    return [
      { ...key(['k'], 'k', 'show it: over one picture, the other, none', () => this.cycle(pictures())),
        when: undefined },
      key([...arrows, ...arrows.map((name) => 'Shift+' + name)], '← ↑ ↓ →', 'move it (shift: finely)',
        (name) => {
          const [dx, dy] = ARROWS[name.replace('Shift+', '')];
          const step = name.startsWith('Shift+') ? FINE : STEP;
          this.move(step * dx, step * dy);
        }),
      key(['Enter', 'Shift+Enter'], 'Enter', 'click there (shift: as shift-click)',
        (name) => this.click(name !== 'Enter')),
      key(['v'], 'v', 'press there, then let go: to drag and to draw', () => this.press()),
      key(['Escape'], 'Esc', 'away with it', () => {
        this.hide();
        away();
      }),
    ];
  }
}
