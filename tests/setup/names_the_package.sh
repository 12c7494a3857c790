#!/usr/bin/env bash
# install_packages names the package that cannot be installed, and fails. Its apt-get is one that
# refuses one package of three.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
cat >"$folder/apt-get" <<'APT'
#!/usr/bin/env bash
case " $* " in *" refused "*) exit 100 ;; esac
APT
printf '#!/usr/bin/env bash\n[[ $1 == true ]] || exec "$@"\n' >"$folder/sudo"
chmod +x "$folder/apt-get" "$folder/sudo"
PATH=$folder:$PATH

source "$1/cmake/setup.sh"
missing_packages() { printf '%s\n' first refused third; }
status=0
message=$(install_packages build 2>&1) || status=$?
if ((status == 0)) || ! grep -qx "These packages cannot be installed: refused" <<<"$message"; then
  echo "expected the name of the package that is refused and a failure, got status $status and:"
  echo "$message"
  exit 1
fi
