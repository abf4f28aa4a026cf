// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sliders for numbers of which only the legal range is known: a range that is of use around the
// value, on a scale of ratios where it spans many of them.

import GUI from 'lil-gui';
import type { Controller } from 'lil-gui';

export interface Knob {
  name: string;
  value: number | boolean | string;
  low: number | null;
  high: number | null;
  whole?: boolean;
  unit: string;
  help: string;
  choices?: string[];
}

function rangeOf(knob: Knob, value: number): [number, number] {
  const legalLow = knob.low ?? -Infinity;
  const legalHigh = knob.high ?? Infinity;
  if (legalHigh - legalLow <= 20) return [legalLow, legalHigh];
  const about = value !== 0 ? Math.abs(value) : 1;
  const low = value < 0 || legalLow < 0 ? -4 * about : 0;
  return [Math.max(low, legalLow), Math.min(4 * about, legalHigh)];
}

export function stepOf(low: number, high: number): number {
  return 10 ** Math.floor(Math.log10((high - low) / 2000));
}

// Adds the knob to a folder; `turned` hears of every change. Setting beyond the slider's end is
// done by typing.
export function addKnob(
  gui: GUI,
  knob: Knob,
  turned: (value: number | boolean | string) => void,
): Controller {
  const held = { value: knob.value };
  const label = knob.unit ? `${knob.name} [${knob.unit}]` : knob.name;
  let controller: Controller;
  if (knob.choices && knob.choices.length > 0) {
    controller = gui.add(held, 'value', knob.choices);
  } else if (typeof knob.value === 'number') {
    const [low, high] = rangeOf(knob, knob.value);
    const step = knob.whole ? 1 : stepOf(low, high);
    controller = gui.add(held, 'value', low, high, step);
  } else {
    controller = gui.add(held, 'value');
  }
  controller.name(label).onChange(turned);
  controller.domElement.title = knob.help;
  controller.domElement.dataset.knob = knob.name;
  return controller;
}

export function makeGui(container: HTMLElement): GUI {
  return new GUI({ container, injectStyles: false, title: '', width: container.clientWidth });
}
