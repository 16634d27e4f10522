# SPDX-License-Identifier: Apache-2.0
"""Lists the tests that CTest skipped, and fails if one is not due to a missing optional package.

usage: skipped.py RESULTS.xml OPTIONAL    (from ctest --output-junit; tools/optional)
"""
import subprocess
import sys
import xml.etree.ElementTree


def skipped_tests(results):
    """Returns the names of the tests that did not run."""
    cases = xml.etree.ElementTree.parse(results).getroot().iter("testcase")
    return [case.get("name") for case in cases if case.get("status") == "notrun" or case.find("skipped") is not None]


def optional_packages(file):
    """Returns for each test that may be skipped its package and the checks lost without it."""
    lines = [line.split(maxsplit=2) for line in open(file, encoding="utf-8") if line.strip() and not line.startswith("#")]
    return {test: (package, text.strip()) for package, test, text in lines}


def is_installed(package):
    query = subprocess.run(["dpkg-query", "-W", "-f=${Status}", package], capture_output=True, text=True, check=False)
    return "ok installed" in query.stdout


def main():
    results, optional_file = sys.argv[1:]
    optional = optional_packages(optional_file)
    wrong = 0
    names = {case.get("name") for case in xml.etree.ElementTree.parse(results).getroot().iter("testcase")}
    for test in sorted(set(optional) - names):
        print(f"FAILED: tools/optional names {test}, which is no test")
        wrong += 1
    for test in skipped_tests(results):
        package, text = optional.get(test, (None, None))
        if package is None:
            print(f"FAILED: {test} was skipped, and tools/optional does not allow it")
            wrong += 1
        elif is_installed(package):
            print(f"FAILED: {test} was skipped although {package} is installed")
            wrong += 1
        else:
            print(f"skipped: {test}: {text}; {package} is not installed")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
