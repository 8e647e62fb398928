# Sourced by scripts/test and scripts/demo: installs what is missing, builds, sources the result.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build"
package_lists=("$root/scripts/debian_packages")
targets=(all)   # what build_all builds

say() { printf '== %s\n' "$*"; }
give_up() { printf '%s\n' "$*" >&2; exit 1; }

# ROS from another place than Debian's packages: use it, install nothing.
ros_is_sourced() { [[ -n "${ROS_DISTRO:-}" && "${ROS_DISTRO}" != Debian && -n "${CMAKE_PREFIX_PATH:-}" ]]; }

as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    give_up "scripts: '$*' needs root: run this as root, or install sudo"
  fi
}

missing_packages() {
  local package
  grep -hv '^#' "${package_lists[@]}" | while read -r package; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
  done
}

install_packages() {
  command -v apt-get >/dev/null ||
    give_up "scripts: no ROS 1 is sourced and this is no Debian: source a ROS 1 setup file first"
  local missing
  missing=$(missing_packages)
  [[ -n "$missing" ]] || return 0
  say "installing from Debian's packages:" $missing
  as_root apt-get update -qq
  # shellcheck disable=SC2086  # one word a package
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    $missing >/dev/null || give_up "scripts: apt-get could not install the packages above"
}

# Debian's ROS belongs to Debian's python3: another one earlier on PATH has no catkin.
prefer_debian_python() { export PATH="/usr/bin:$PATH"; }

configure() {
  local cache="$build/CMakeCache.txt"
  if [[ -f "$cache" ]] && ! ros_is_sourced &&
     ! grep -Eq '^PYTHON_EXECUTABLE:.*=/usr/bin/python3' "$cache"; then
    say "the build directory was configured with another python3: starting it anew"
    rm -rf "$build"
  fi
  mkdir -p "$build"
  cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX="$build/.install" "$@" >"$build/configure.log" 2>&1 ||
    { tail -n 30 "$build/configure.log" >&2; give_up "scripts: configuring failed"; }
}

get_packages() {
  if ros_is_sourced; then
    say "using the sourced ROS $ROS_DISTRO"
  else
    install_packages
    prefer_debian_python
  fi
}

compile() { cmake --build "$build" --target "$@" -- -j"$(nproc)" 2>&1 | tee -a "$build/build.log"; }

build_all() {
  say "building in $build"
  configure "$@"
  : >"$build/build.log"
  compile "${targets[@]}" || give_up "scripts: building failed"
  # Setup files of catkin read variables that are not set.
  set +u
  # shellcheck disable=SC1091
  source "$build/devel/setup.bash"
  set -u
  # A host whose own name does not resolve cannot reach its own nodes by it.
  if [[ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ]] && ! getent hosts "$(uname -n)" >/dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}

prepare() {
  get_packages
  build_all "$@"
}
