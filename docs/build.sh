#!/usr/bin/env bash
# Builds the site of the documentation into build/site: the pages of this repository by MkDocs, the reference of the headers
# by Doxygen. Then every link and anchor within the site is looked up; one that leads nowhere is an error.
#
#   docs/build.sh      Debian: mkdocs-material doxygen. Look at it: python3 -m http.server -d build/site
#
# Exits with 77 where one of them is not installed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
for tool in mkdocs doxygen python3; do
  command -v $tool >/dev/null || { echo "skipped: no $tool" >&2; exit 77; }
done
[[ -e /usr/share/mkdocs/themes/material ]] || { echo "skipped: no mkdocs-material" >&2; exit 77; }

# The pages where they lie in the repository, so that the links between them hold.
pages=build/site-pages
rm -rf "$pages" build/site
mkdir -p "$pages"
cp --parents -rL docs scenes README.md CHANGELOG.md CONTRIBUTING.md LICENSE "$pages"
mv "$pages/docs/site/reference.md" "$pages/docs"
rm -r "$pages/docs/site" "$pages/docs/build.sh"
while read -r page; do
  docs/site/separate_lists.awk "$pages/$page" >build/page.md
  mv build/page.md "$pages/$page"
done < <(cd "$pages" && find . -name '*.md')
doxygen docs/site/Doxyfile
mkdocs build --config-file docs/site/mkdocs.yml >build/site.log 2>&1 || { cat build/site.log >&2; exit 1; }
docs/site/check_links.py build/site
