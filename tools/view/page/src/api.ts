// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Requests to the server below the page's own address, which holds the token.

const base = new URL('.', location.href);

export const address = (path: string): string => new URL(path, base).href;

// The server heard, and said no.
export class Refusal extends Error {}

async function checked(response: Response): Promise<Response> {
  if (response.ok) return response;
  let reason = `the server answers ${response.status}`;
  try {
    reason = ((await response.json()) as { error: string }).error;
  } catch {
    // no words in it
  }
  throw new Refusal(reason);
}

export async function getJson<T>(path: string): Promise<T> {
  return (await checked(await fetch(address(path)))).json() as Promise<T>;
}

export async function getBytes(path: string, signal?: AbortSignal): Promise<ArrayBuffer> {
  return (await checked(await fetch(address(path), { signal }))).arrayBuffer();
}

export async function getBlob(path: string, signal?: AbortSignal): Promise<Blob> {
  return (await checked(await fetch(address(path), { signal }))).blob();
}

export async function post<T>(path: string, body: unknown = {}): Promise<T> {
  const response = await fetch(address(path), {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify(body),
  });
  return (await checked(response)).json() as Promise<T>;
}

// News from the server; `gone` hears whether there still is one.
export function listen(
  names: Record<string, (data: never) => void>,
  gone: (isGone: boolean) => void,
): void {
  const events = new EventSource(address('api/events'));
  for (const [name, take] of Object.entries(names)) {
    events.addEventListener(name, (event) => take(JSON.parse(event.data as string) as never));
  }
  events.onopen = () => gone(false);
  events.onerror = () => gone(true);
}
