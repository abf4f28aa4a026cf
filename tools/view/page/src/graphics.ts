// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the browser can draw with. Asking takes a browser that has just started a tenth of a second,
// so the processor draws the first pictures; if there is a graphics card, it takes over.

export type Means = 'card' | 'processor' | 'no WebGL';
export const NO_WEBGL = 'This browser has no WebGL 2: the processor draws.';
let means: Means | undefined;
let waiting: (() => void)[] = [];

function find(): Means {
  try {
    const gl = document.createElement('canvas').getContext('webgl2');
    if (!gl) return 'no WebGL';
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : '';
    gl.getExtension('WEBGL_lose_context')?.loseContext();
    // With #card in the address what there is of a card draws, so that the two can be compared.
    if (location.hash === '#card') return 'card';
    return /swiftshader|llvmpipe|software/i.test(name) ? 'processor' : 'card';
  } catch {
    return 'no WebGL';
  }
}

// To be asked when the first pictures are in sight.
export function askForCard(): Means {
  means ??= find();
  const told = waiting;
  waiting = [];
  if (means === 'card') for (const take of told) take();
  return means;
}

// Calls `take` if there is a card, once that is known.
export function onCard(take: () => void): void {
  if (means === undefined) waiting.push(take);
  else if (means === 'card') take();
}

// A canvas over another one, on which the card draws: what belongs to the one below still does.
export function canvasOver(canvas: HTMLCanvasElement): HTMLCanvasElement {
  const over = document.createElement('canvas');
  over.className = 'over';
  over.ariaHidden = 'true';
  canvas.after(over);
  canvas.width = canvas.height = 1;
  return over;
}

// The context of a flat picture. The processor's is kept in plain memory: a thousand lines take the
// browser's own emulation of a card seconds.
export function flatContext(canvas: HTMLCanvasElement, isOnCard = false): CanvasRenderingContext2D {
  return canvas.getContext('2d', { willReadFrequently: !isOnCard }) as CanvasRenderingContext2D;
}
