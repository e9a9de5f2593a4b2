# SPDX-License-Identifier: MIT
"""Makes NAME.ipynb of NAME.py, executed: execute.py NAME.py OUT.ipynb. Cells begin with # %%."""
import sys
import time

import nbformat
from nbclient import NotebookClient


def notebook_of(source):
    cells, markdown = [], False
    lines: "list[str]" = []

    def close():
        text = "\n".join(lines).strip()
        if text:
            if markdown:
                text = "\n".join(line[2:] if line.startswith("# ") else line.lstrip("#") for line in text.splitlines())
            cells.append((nbformat.v4.new_markdown_cell if markdown else nbformat.v4.new_code_cell)(text))

    for line in source.splitlines():
        if line.startswith("# SPDX"):
            continue
        if line.startswith("# %%"):
            close()
            lines, markdown = [], "[markdown]" in line
        else:
            lines.append(line)
    close()
    for number, cell in enumerate(cells):
        cell["id"] = f"cell-{number}"
    return nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": {
        "name": "python3", "display_name": "Python 3", "language": "python"}})


if __name__ == "__main__":
    source, out = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        notebook = notebook_of(file.read())
    began = time.monotonic()
    NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    seconds = time.monotonic() - began
    for cell in notebook.cells:
        cell.get("metadata", {}).pop("execution", None)
    nbformat.write(notebook, out)
    print(f"{source}: {seconds:.1f} s")
