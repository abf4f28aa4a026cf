// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours of animals by their place in the list: Okabe and Ito (2008) and Tol (2021), apart for
// colour-blind eyes; a darker set on light ground, a lighter one on dark.

const LIGHT = ['#0072b2', '#d55e00', '#009e73', '#b3599a', '#c98a00', '#3f9bd4', '#882255', '#7d7d22'];
const DARK = ['#4fa8e0', '#ff8a4c', '#2cc79b', '#e29bc6', '#f2b733', '#8ccbf2', '#d97bab', '#c2c24f'];

export function colourOf(animal: number, dark: boolean): string {
  return (dark ? DARK : LIGHT)[animal % LIGHT.length];
}

// On footage, whatever is under it.
export const colourOnFootage = (animal: number): string => DARK[animal % DARK.length];

export interface Ground {
  back: string;
  grid: string;
  ink: string;
  ghost: string;
}
export const ground = (dark: boolean): Ground =>
  dark
    ? { back: '#12161c', grid: '#2b3440', ink: '#9aa6b5', ghost: '#7b8796' }
    : { back: '#f2f4f7', grid: '#d3d9e0', ink: '#5d6877', ghost: '#8a94a1' };
