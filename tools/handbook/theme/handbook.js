// SPDX-License-Identifier: MIT
document.addEventListener("DOMContentLoaded", () => {
  // Mathematics, drawn by KaTeX where Markdown left it between \( \) and \[ \].
  renderMathInElement(document.body, {
    delimiters: [{ left: "\\(", right: "\\)", display: false }, { left: "\\[", right: "\\]", display: true }] });
  // The keyboard reaches all that scrolls. The theme would take this away again where there is no mouse.
  for (const block of document.querySelectorAll("pre > code, .md-typeset__scrollwrap, .md-search__scrollwrap, .katex-display")) {
    block.tabIndex = 0;
    block.removeAttribute = (name) => name === "tabindex" || Element.prototype.removeAttribute.call(block, name);
  }
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
});
