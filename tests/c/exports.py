"""libneedlework.so exports the functions of needlework.h, all of them and nothing else.

    exports.py LIBRARY HEADER
"""

import re
import subprocess
import sys
from pathlib import Path


def main(library, header):
    text = re.sub(r"/\*.*?\*/", "", Path(header).read_text(), flags=re.S)
    declared = set(re.findall(r"^NEEDLEWORK_API\b[^;(]*?\b(needlework_\w+)\(", text, flags=re.M))
    assert len(declared) > 20, declared
    lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True, text=True,
                           stdout=subprocess.PIPE).stdout.splitlines()
    # The name of the version of the interface, NEEDLEWORK_1, is an absolute symbol.
    exported = {line.split()[-1].partition("@")[0] for line in lines if line.split()[-2] != "A"}
    assert exported == declared, {"not declared": exported - declared,
                                  "not exported": declared - exported}
    versions = {line.split()[-1].partition("@@")[2] for line in lines if line.split()[-2] != "A"}
    assert versions == {"NEEDLEWORK_1"}, versions
    assert Path(library).resolve().name.startswith("libneedlework.so.5"), library


if __name__ == "__main__":
    main(*sys.argv[1:])
