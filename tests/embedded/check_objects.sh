# usage: check_objects.sh NM OBJECT …: fails if an object calls the heap or throws.
nm=$1
shift
undefined=$("$nm" -C -u "$@") || exit 1
found=$(echo "$undefined" | grep -E ' U (malloc|calloc|realloc|free|operator (new|delete).*|__cxa_.*|std::__throw.*|std::terminate.*)$')
if [ -n "$found" ]; then
    echo "these freestanding parts call:"
    echo "$found"
    exit 1
fi
echo "$# objects are freestanding"
