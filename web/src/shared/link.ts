// The button that copies the address of all that is seen, and the page inside another one.
import { element } from './dom';
import { writeLink } from './store';

/** Links above this are cut by some programs that pass them on. */
const LONG = 8_000;
const TOLD_MS = 4_000;

const button = element('copy-link', HTMLButtonElement);
const told = element('copied', HTMLElement);
let timer = 0;

function tell(text: string): void {
  told.textContent = text;
  clearTimeout(timer);
  timer = window.setTimeout(() => (told.textContent = ''), TOLD_MS);
}

button.addEventListener('click', async () => {
  const { url, isWhole } = await writeLink();
  try {
    await navigator.clipboard.writeText(url);
  } catch {
    tell('Copy the address of the page: the browser does not let it');
    return;
  }
  const length = `${Math.ceil(url.length / 1000)} KB`;
  if (!isWhole) tell('Copied, but for a text that is too long for a link: send its file, too');
  else tell(url.length > LONG ? `Copied: ${length}, which some programs cut` : 'Copied');
});

// Inside another page, a way to all of it.
const whole = document.getElementById('whole');
if (whole instanceof HTMLAnchorElement) {
  const point = async () => {
    const url = new URL((await writeLink()).url);
    url.searchParams.delete('embed');
    whole.href = url.href;
  };
  for (const event of ['pointerenter', 'focus']) whole.addEventListener(event, point);
}
