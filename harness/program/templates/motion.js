/* @{title} */
"use strict";

const @{name} = (() => {
  const {@{functions}, pow} = Math;
  const square = x => x*x, cube = x => x*x*x;@{in_span}
  const erf = x => {  // exp(-x^2) times the series of positive terms; 1 to rounding beyond 6
    if (fabs(x) > 6) return sign(x);
    let term = x, sum = x;
    for (let n = 1; fabs(term) > 1e-17*fabs(sum); n++) sum += term *= 2*x*x/(2*n + 1);
    return 2/sqrt(Math.PI)*exp(-x*x)*sum;
  };
  const inputs = @{inputs};
  const outputs = @{outputs};

  /* Takes the values of inputs, returns those of outputs. */
  function evaluate(values) {
    const results = new Array(@{count});
@{body}
    return results;
  }
  return {inputs, outputs, evaluate};
})();

if (typeof module === "object") module.exports = @{name};
