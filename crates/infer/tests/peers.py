# The same decay fitted by scipy.optimize and sampled by emcee; a power law with errors in
# both coordinates by scipy.optimize.
import json

import emcee
import numpy as np
from scipy.optimize import least_squares

data = json.load(open("data.json"))
x, y, sigma = (np.array(data[key]) for key in ("x", "y", "sigma"))
exact = {"xtol": 1e-15, "ftol": 1e-15, "gtol": 1e-15}


def residuals(p):
    return (y - p[0] * np.exp(-p[1] * x)) / sigma


def jacobian(p):
    bell = np.exp(-p[1] * x)
    return np.stack([-bell / sigma, p[0] * x * bell / sigma], axis=1)


found = {}
for loss in ("linear", "soft_l1", "huber", "cauchy"):
    fit = least_squares(residuals, [1.3, 0.5], jacobian, loss=loss, f_scale=1.5, **exact)
    found[loss] = [*fit.x, fit.cost]
    if loss == "linear":
        best = fit.x
        covariance = np.linalg.inv(fit.jac.T @ fit.jac)
fit = least_squares(residuals, [0.8, 0.5], jacobian, bounds=([0.0, 0.0], [0.9, 3.0]), **exact)
found["bounded"] = [*fit.x, fit.cost]
found["covariance"] = list(covariance.flatten())

np.random.seed(1)
sampler = emcee.EnsembleSampler(32, 2, lambda p: -0.5 * np.sum(residuals(p) ** 2))
sampler.run_mcmc(np.random.multivariate_normal(best, covariance, 32), 6000)
chain = sampler.get_chain(discard=500)
found["mean"] = list(chain.reshape(-1, 2).mean(axis=0))
found["sd"] = list(chain.reshape(-1, 2).std(axis=0))
found["time"] = list(emcee.autocorr.integrated_time(chain))
found["acceptance"] = [float(sampler.acceptance_fraction.mean())]

# y = a x^b: the true x are free beside a and b, and all distances count in their own errors.
law = {key: np.array(value) for key, value in data["law"].items()}
ln_x, ln_y = np.log(law["x"]), np.log(law["y"])
ln_x_sigma, ln_y_sigma = law["x_sigma"] / law["x"], law["y_sigma"] / law["y"]


def distances(p):
    true = p[2:]
    return np.concatenate([(ln_x - true) / ln_x_sigma, (ln_y - p[0] - p[1] * true) / ln_y_sigma])


fit = least_squares(distances, [ln_y.mean(), 0.0, *ln_x], x_scale="jac", **exact)
covariance = np.linalg.inv(fit.jac.T @ fit.jac)
found["law"] = [np.exp(fit.x[0]), fit.x[1], 2 * fit.cost, *np.sqrt(np.diag(covariance)[:2])]
print(json.dumps(found))
