# Says why the embedded tests cannot run here; where they are required, that is a failure.
case ",${XORVOX_REQUIRE:-}," in
    *,embedded,*) echo "required, but $1"; exit 1 ;;
esac
echo "SKIPPED: $1"
