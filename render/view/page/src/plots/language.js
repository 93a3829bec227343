/**
 * uPlot asks for the numbers of the browser's language as soon as it is loaded, and nothing of the page would start where
 * that is no language at all: WebKit says "c" in the locale C. The page itself writes numbers with a decimal point.
 */
try {
  new Intl.NumberFormat(navigator.language);
} catch {
  Object.defineProperty(navigator, "language", { value: "en" });
}
