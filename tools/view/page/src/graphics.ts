// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the browser can draw with.

export function hasWebGL(): boolean {
  try {
    const canvas = document.createElement('canvas');
    return canvas.getContext('webgl2') !== null;
  } catch {
    return false;
  }
}

let software: boolean | undefined;

// Whether the processor draws, for want of a graphics card: then every sample of a pixel is dear.
export function drawsInSoftware(): boolean {
  software ??= findSoftware();
  return software;
}

function findSoftware(): boolean {
  try {
    const gl = document.createElement('canvas').getContext('webgl2');
    const names = gl?.getExtension('WEBGL_debug_renderer_info');
    const name = gl && names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : '';
    gl?.getExtension('WEBGL_lose_context')?.loseContext();
    return /swiftshader|llvmpipe|software/i.test(name);
  } catch {
    return false;
  }
}

// The context of a flat picture. Without a graphics card it is kept in plain memory: a thousand
// lines take the browser's own emulation of a card seconds.
export function flatContext(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext('2d', { willReadFrequently: drawsInSoftware() });
  return context as CanvasRenderingContext2D;
}
