// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the browser can draw with: asked once, for asking takes a while.

export interface Means {
  webgl: boolean;
  software: boolean;
}
let means: Means | undefined;

function find(): Means {
  try {
    const gl = document.createElement('canvas').getContext('webgl2');
    if (!gl) return { webgl: false, software: false };
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : '';
    gl.getExtension('WEBGL_lose_context')?.loseContext();
    return { webgl: true, software: /swiftshader|llvmpipe|software/i.test(name) };
  } catch {
    return { webgl: false, software: false };
  }
}

export const findMeans = (): Means => (means ??= window.asked?.means ?? find());
export const hasWebGL = (): boolean => findMeans().webgl;

// Whether the processor draws, for want of a graphics card. With #card in the address what there is
// of a card draws all the same, so that the two ways can be compared.
export const drawsInSoftware = (): boolean => findMeans().software && location.hash !== '#card';

// The context of a flat picture. Without a graphics card it is kept in plain memory: a thousand
// lines take the browser's own emulation of a card seconds.
export function flatContext(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext('2d', { willReadFrequently: drawsInSoftware() });
  return context as CanvasRenderingContext2D;
}
