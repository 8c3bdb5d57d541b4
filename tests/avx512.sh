#!/usr/bin/env bash
# Boots Linux on an emulated processor that has AVX-512 (Bochs' Skylake-X), runs the compare command and
# the stress cases there, and compares every bit of the crystal ball with this machine's scalar picture.
#
#   tests/avx512.sh [CASE...]       the stress cases to run; all if absent
#
# Needs, once, on x86-64 Debian:
#   apt-get install bochs bochs-term bochsbios vgabios busybox-static grub-common grub-pc-bin xorriso mtools \
#       bsdutils linux-image-amd64
# Of the kernel only the file is read. To spare installing it, unpack one and name it in VMLINUZ:
#   apt-get download linux-image-6.1.0-56-amd64 && dpkg -x linux-image-6.1.0-56-amd64_*.deb kernel
#   VMLINUZ=kernel/boot/vmlinuz-6.1.0-56-amd64 tests/avx512.sh
# Where something is not installed it says so and exits with 77, as a skipped test does.
#
# Takes some 20 minutes and the build, on one core; two of them until Linux is up. SIZE (80x60) is that of the
# pictures, JOBS (all cores) that of the build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bios=/usr/share/bochs/BIOS-bochs-latest
vga_bios=/usr/share/vgabios/vgabios.bin
for tool in bochs busybox grub-mkrescue xorriso mformat script; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool" >&2; exit 77; }
done
for file in "$bios" "$vga_bios" /usr/lib/grub/i386-pc/moddep.lst; do
  [[ -e $file ]] || { echo "skipped: no $file" >&2; exit 77; }
done
compgen -G '/usr/lib/*/bochs/plugins/libbx_term_gui.so' >/dev/null || { echo "skipped: no bochs-term" >&2; exit 77; }
if ldd "$(command -v busybox)" >/dev/null 2>&1; then
  echo "skipped: busybox is not static" >&2
  exit 77
fi
vmlinuz=${VMLINUZ:-$(compgen -G '/boot/vmlinuz-*' | sort -V | tail -1 || true)}
[[ -r $vmlinuz ]] || { echo "skipped: no kernel in /boot and none named in VMLINUZ" >&2; exit 77; }

# Bochs 2.7 takes a gather whose index is in one of zmm16 to zmm31 for an illegal instruction: the compiler
# must leave these registers alone. But for that the build is the usual one.
cmake -S . -B build/avx512 -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="$(printf -- '-ffixed-xmm%d ' {16..31})" -DSHEAF_BUILD_TESTS=OFF -DSHEAF_BUILD_BENCH=OFF
cmake --build build/avx512 --parallel "${JOBS:-$(nproc)}" --target sheaf
sheaf=build/avx512/sheaf

folder=$(mktemp -d)
helpers=()
clean_up() {
  [[ ${#helpers[@]} -eq 0 ]] || kill "${helpers[@]}" 2>/dev/null || true
  rm -rf "$folder"
}
trap clean_up EXIT

# The guest's files are all in its initial memory disk: busybox, the command, its libraries, the scene, and
# what the pictures are to be.
scene=(scenes/crystal-ball.json --views seven --size "${SIZE:-80x60}")
"$sheaf" render "${scene[@]}" -q --target scalar -o "$folder/{camera}.pfm"
root=$folder/root
mkdir -p "$root"/{bin,dev,proc,scenes,tmp}
(cd "$folder" && sha256sum -- *.pfm) >"$root/sums"
cp "$(command -v busybox)" "$sheaf" "$root/bin/"
cp scenes/crystal-ball.json scenes/sheaf.schema.json "$root/scenes/"
for library in $(ldd "$sheaf" | grep -o '/[^ ]*'); do
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done
cat >"$root/init" <<INIT
#!/bin/busybox sh
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc
mount -t devtmpfs dev /dev
exec >/dev/ttyS0 2>&1 </dev/null
result=passed
try() {
  echo "# \$*"
  "\$@" || { echo "exit code \$?"; result=failed; }
}
echo "\$(grep -m 1 'model name' /proc/cpuinfo)"
echo "flags: \$(grep -m 1 '^flags' /proc/cpuinfo | tr ' ' '\n' | grep avx | tr '\n' ' ')"
try sheaf info
try sheaf compare ${scene[*]} --targets scalar,avx3,avx2
try sheaf compare ${scene[*]} --targets scalar,avx3,avx2 --precision double
try sheaf render ${scene[*]} -q --target avx3 -o '/tmp/{camera}.pfm'
cd /tmp && try sha256sum -c /sums
try sheaf stress $*
dmesg | grep -E 'traps:|segfault' && result=failed  # with the address of an illegal instruction
echo "guest: \$result"
sleep 1
for letter in S h u t d o w n; do  # written to this port, the word ends Bochs
  printf %s \$letter | dd of=/dev/port bs=1 seek=\$((0x8900)) 2>/dev/null
done
sleep 60
INIT
chmod +x "$root/init"

# XSAVES off, because with it the kernel finds the emulated sizes inconsistent and leaves AVX off.
mkdir -p "$folder/iso/boot/grub"
cp "$vmlinuz" "$folder/iso/boot/vmlinuz"
(cd "$root" && find . | busybox cpio -o -H newc 2>/dev/null | gzip -1) >"$folder/iso/boot/initrd"
cat >"$folder/iso/boot/grub/grub.cfg" <<'GRUB'
set timeout=0
menuentry sheaf {
  linux /boot/vmlinuz console=ttyS0 loglevel=1 nokaslr mitigations=off lpj=1000000 noapic nosmp clearcpuid=xsaves,xsavec panic=-1 rdinit=/init
  initrd /boot/initrd
}
GRUB
grub-mkrescue -d /usr/lib/grub/i386-pc -o "$folder/sheaf.iso" "$folder/iso" >"$folder/iso.log" 2>&1 ||
  { cat "$folder/iso.log" >&2; exit 1; }
cat >"$folder/bochsrc" <<BOCHS
display_library: term
config_interface: textconfig
cpu: model=corei7_skylake_x, count=1, ips=50000000, reset_on_triple_fault=0, ignore_bad_msrs=1
memory: guest=1024, host=1024
romimage: file=$bios, options=fastboot
vgaromimage: file=$vga_bios
pci: enabled=1, chipset=i440fx
clock: sync=none
ata0: enabled=1, ioaddr1=0x1f0, ioaddr2=0x3f0, irq=14
ata0-master: type=cdrom, path=$folder/sheaf.iso, status=inserted
boot: cdrom
speaker: enabled=0
com1: enabled=1, mode=file, dev=$folder/serial
log: $folder/bochs.log
panic: action=fatal
error: action=ignore
info: action=ignore
debug: action=ignore
BOCHS
echo continue >"$folder/debugger" # Debian's Bochs starts in its debugger

# What the guest says comes by its serial line. Bochs also draws the guest's screen, on a terminal that it
# opens and names: somebody must read that, or Bochs waits when the terminal is full.
: >"$folder/serial"
: >"$folder/screen"
tail -f -n +1 "$folder/serial" &
helpers+=($!)
(
  until terminal=$(sed -n 's/.*connected to screen "\(.*\)".*/\1/p' "$folder/screen") && [[ -n $terminal ]]; do
    sleep 1
  done
  exec cat "$terminal" >/dev/null 2>&1
) &
helpers+=($!)
TERM=xterm timeout 7200 script -qec "bochs -q -f '$folder/bochsrc' -rc '$folder/debugger'" /dev/null \
  </dev/null >"$folder/screen" || true
sleep 2
if ! tr -d '\r' <"$folder/serial" | grep -qx 'guest: passed'; then
  tail -20 "$folder/bochs.log" >&2
  exit 1
fi
