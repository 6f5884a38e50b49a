# usage: check_firmware.sh NM SIZE ELF: fails if the firmware holds what a microcontroller must not need.
nm=$1 size=$2 elf=$3
found=$("$nm" -C "$elf" | grep -E ' (_?malloc(_r)?|_?free(_r)?|_sbrk(_r)?|operator (new|delete).*|__cxa_.*|__gxx_.*|_Unwind_.*|vtable for .*|typeinfo for .*|__aeabi_([df]|u?[il]2[df]).*)$')
if [ -n "$found" ]; then
    echo "the firmware holds:"
    echo "$found"
    exit 1
fi
"$nm" -C "$elf" | grep -q 'xorvox::device::Device::poll' || { echo "$elf does not hold the device half"; exit 1; }
"$size" "$elf"
"$size" "$elf" | awk 'NR == 2 { printf "flash %d bytes, RAM %d bytes with the test'"'"'s buffers and stack\n", $1 + $2, $2 + $3 }'
