// Keeps what was put in: short values in the address, so that it can be sent; texts in the browser.

/** A value of the address, if it is there. */
export function fromAddress(name: string): string | null {
  return new URLSearchParams(location.search).get(name);
}

/** Puts values into the address; null takes one out. */
export function toAddress(values: Record<string, string | null>): void {
  const query = new URLSearchParams(location.search);
  for (const [name, value] of Object.entries(values)) {
    if (value === null) query.delete(name);
    else query.set(name, value);
  }
  const text = query.size > 0 ? `?${query}` : location.pathname;
  history.replaceState(null, '', text + location.hash);
}

/** A text that this browser has kept. */
export function kept(name: string): string | null {
  try {
    return localStorage.getItem(`pose2pulse ${name}`);
  } catch {
    return null; // The store is closed to this page.
  }
}

/** Keeps a text; null forgets it. Without room or permission it is not kept. */
export function keep(name: string, text: string | null): void {
  try {
    if (text === null) localStorage.removeItem(`pose2pulse ${name}`);
    else localStorage.setItem(`pose2pulse ${name}`, text);
  } catch {
    // The page works without.
  }
}
